#include "measurements/odometer.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

Measurement Reading(Odometer::Form form, double speed) {
  Odometer odometer;
  odometer.form = form;
  odometer.speed = speed;
  odometer.sigma = {0.1, 0.2, 0.3};
  return {0.0, 0, false, odometer};
}

/// East at 10 m/s, drifting north at 1 m/s and sinking at 0.5 m/s, turning to
/// the right at 0.2 rad/s; axle at (2, 3, -1): v_o = (9.4, -0.6, 0.5).
Scene OdometerHeadingEast() {
  Scene scene;
  scene.state = MakeState(0.0, {0.0, 0.0, 10.0}, {1.0, 10.0, 0.5},
                          {0.0, 0.0, 90.0 * kDegree});
  scene.state.b_g = {0.01, 0.02, 0.03};
  scene.kinematics.w_ib_b = scene.state.q_eb.conjugate() * EarthRate_e() +
                            Eigen::Vector3d(0.0, 0.0, 0.2) + scene.state.b_g;
  scene.sensor.lever_arm_b = {2.0, 3.0, -1.0};
  scene.sensor.scale = 0.02;
  return scene;
}

TEST(Odometer, ThreeAxesWithLeverArmAtHeading90Degrees) {
  const LinearizedMeasurement z = OdometerHeadingEast().Evaluate(
      Reading(Odometer::Form::kThreeAxis, 1.02 * 9.4 + 0.05));
  ASSERT_EQ(z.residual.size(), 3);
  EXPECT_LT((z.residual - Eigen::Vector3d(0.05, 0.6, -0.5)).norm(), 1e-12);
  // North, east and down velocity of the vehicle in forward, right, down.
  Eigen::Matrix3d H_v;
  H_v << 0.0, 1.02, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  EXPECT_LT((z.H.middleCols<3>(3) - H_v).norm(), 1e-12);
  EXPECT_LT((z.R.diagonal() - Eigen::Vector3d(0.01, 0.04, 0.09)).norm(), 1e-15);
}

TEST(Odometer, AnErrorOfTheSensorAddsToItsRows) {
  for (const auto form : {Odometer::Form::kForward, Odometer::Form::kThreeAxis,
                          Odometer::Form::kNonHolonomic}) {
    Scene scene = RichScene();
    const Measurement z = Reading(form, 9.0);
    const RowVector without = scene.Evaluate(z).residual;
    Block block;
    block.key = {BlockKind::kSensorError, 0};
    block.name = "odometer_error";
    scene.layout.Add(block);
    ParameterVector& values = scene.state.parameters;
    values.conservativeResize(scene.layout.parameter_count());
    values.tail<3>() << 2.0, -1.0, 0.5;
    const RowVector with = scene.Evaluate(z).residual;
    EXPECT_LT((without - with - values.tail<3>().head(with.size())).norm(),
              1e-12);
    ExpectJacobian(scene, z, "with an error");
  }
}

TEST(Odometer, FormsAreRowsOfTheThreeAxes) {
  const Scene scene = RichScene();
  const LinearizedMeasurement all =
      scene.Evaluate(Reading(Odometer::Form::kThreeAxis, 9.0));
  const LinearizedMeasurement forward =
      scene.Evaluate(Reading(Odometer::Form::kForward, 9.0));
  const LinearizedMeasurement others =
      scene.Evaluate(Reading(Odometer::Form::kNonHolonomic, 0.0));
  ASSERT_EQ(forward.residual.size(), 1);
  ASSERT_EQ(others.residual.size(), 2);
  EXPECT_EQ(forward.residual(0), all.residual(0));
  EXPECT_EQ(forward.H, all.H.topRows(1));
  EXPECT_EQ(forward.R(0, 0), all.R(0, 0));
  EXPECT_EQ(others.residual, all.residual.tail(2));
  EXPECT_EQ(others.H, all.H.bottomRows(2));
  EXPECT_EQ(others.R, all.R.bottomRightCorner(2, 2));
}

TEST(Odometer, MountingTurnsTheVehicleAxes) {
  // The odometer's forward is the body's right.
  Scene scene = OdometerHeadingEast();
  scene.sensor.scale = 0.0;
  scene.sensor.q_sb = Exp(Eigen::Vector3d(0.0, 0.0, -90.0 * kDegree));
  const LinearizedMeasurement z =
      scene.Evaluate(Reading(Odometer::Form::kThreeAxis, -0.6));
  EXPECT_LT((z.residual - Eigen::Vector3d(0.0, 9.4, -0.5)).norm(), 1e-12);
}

TEST(Odometer, NoResidualWhereMeasuredIsPredicted) {
  const Scene scene = RichScene();
  const LinearizedMeasurement z =
      scene.Evaluate(Reading(Odometer::Form::kForward, 0.0));
  const double predicted = -z.residual(0);
  // Rounding of the offset's part, which is subtracted last.
  EXPECT_NEAR(
      scene.Evaluate(Reading(Odometer::Form::kForward, predicted)).residual(0),
      0.0, 1e-14);
}

TEST(Odometer, JacobianMatchesNumericDifference) {
  const Scene scene = RichScene();
  ExpectJacobian(scene, Reading(Odometer::Form::kThreeAxis, 12.0), "odometer");
  ExpectJacobian(scene, Reading(Odometer::Form::kForward, 12.0), "forward");
  ExpectJacobian(scene, Reading(Odometer::Form::kNonHolonomic, 0.0),
                 "non-holonomic");
}

}  // namespace
}  // namespace hindsight
