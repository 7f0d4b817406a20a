#include "measurements/dvl.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

Dvl ThreeAxis(const Eigen::Vector3d& v_d) {
  Dvl dvl;
  dvl.speed.head<3>() = v_d;
  dvl.sigma = {0.01, 0.02, 0.03, 1.0};
  return dvl;
}

Dvl Janus(const Eigen::Vector3d& v_d) {
  Dvl dvl;
  dvl.form = Dvl::Form::kBeams;
  dvl.beam_angle = 30.0 * kDegree;
  dvl.beam_azimuth = 45.0 * kDegree;
  for (int i = 0; i < 4; ++i) dvl.speed(i) = dvl.Direction(i).dot(v_d);
  dvl.sigma.setConstant(0.02);
  return dvl;
}

/// East at 3 m/s, drifting north at 0.5 m/s and sinking at 0.2 m/s, turning to
/// the right at 0.1 rad/s; transducer at (2, 3, -1): v_b + w x l =
/// (3 - 0.3, -0.5 + 0.2, 0.2).
Scene DvlHeadingEast() {
  Scene scene;
  scene.state = MakeState(0.0, {0.0, 0.0, -50.0}, {0.5, 3.0, 0.2},
                          {0.0, 0.0, 90.0 * kDegree});
  scene.state.b_g = {0.01, 0.02, 0.03};
  scene.kinematics.w_ib_b = scene.state.q_eb.conjugate() * EarthRate_e() +
                            Eigen::Vector3d(0.0, 0.0, 0.1) + scene.state.b_g;
  scene.sensor.lever_arm_b = {2.0, 3.0, -1.0};
  scene.sensor.scale = 0.02;
  return scene;
}
const Eigen::Vector3d kTrueVelocity(2.7, -0.3, 0.2);

Scene With(BlockKind kind, const Eigen::Vector3d& v, Scene scene) {
  Block block;
  block.key = {kind, 0};
  block.name = "velocity";
  block.unit = "m/s";
  block.sigma0.setConstant(0.5);
  scene.layout.Add(block);
  ParameterVector values =
      ParameterVector::Zero(scene.layout.parameter_count());
  values.head(scene.state.parameters.size()) = scene.state.parameters;
  values.tail<3>() = v;
  scene.state.parameters = values;
  return scene;
}

TEST(Dvl, ThreeAxesWithLeverArmAtHeading90Degrees) {
  const LinearizedMeasurement z =
      DvlHeadingEast().Evaluate({0.0, 0, false, ThreeAxis(kTrueVelocity)});
  ASSERT_EQ(z.residual.size(), 3);
  EXPECT_LT((z.residual + 0.02 * kTrueVelocity).norm(), 1e-12);
  // North, east and down velocity of the vehicle in forward, right, down.
  Eigen::Matrix3d H_v;
  H_v << 0.0, 1.02, 0.0, -1.02, 0.0, 0.0, 0.0, 0.0, 1.02;
  EXPECT_LT((z.H.middleCols<3>(3) - H_v).norm(), 1e-12);
  EXPECT_LT((z.R.diagonal() - Eigen::Vector3d(1e-4, 4e-4, 9e-4)).norm(), 1e-15);
}

TEST(Dvl, BeamsByHand) {
  // The first beam of this head looks forward, the second to the right.
  Dvl dvl = Janus(Eigen::Vector3d::Zero());
  dvl.beam_azimuth = 0.0;
  const LinearizedMeasurement z =
      DvlHeadingEast().Evaluate({0.0, 0, false, dvl});
  const double c = std::sqrt(0.75);
  const Eigen::Vector4d beams(0.5 * 2.7 + c * 0.2, -0.5 * 0.3 + c * 0.2,
                              -0.5 * 2.7 + c * 0.2, 0.5 * 0.3 + c * 0.2);
  EXPECT_LT((z.residual + 1.02 * beams).norm(), 1e-12);
}

TEST(Dvl, BeamsThatDropOutAreLeftOut) {
  const Scene scene = RichScene();
  Dvl dvl = Janus({1.0, 0.2, -0.1});
  const LinearizedMeasurement all = scene.Evaluate({0.0, 0, false, dvl});
  dvl.valid = {true, false, false, true};
  const LinearizedMeasurement two = scene.Evaluate({0.0, 0, false, dvl});
  ASSERT_EQ(two.residual.size(), 2);
  EXPECT_EQ(two.residual, RowVector(all.residual(Eigen::seq(0, 3, 3))));
  EXPECT_EQ(two.H.row(1), all.H.row(3));
  dvl.valid = {false, false, false, false};
  EXPECT_EQ(dvl.rows(), 0);
}

TEST(Dvl, FourBeamsWeighAsTheirThreeAxes) {
  // Least squares of the beams is the three-axis form; with 30 deg beams of
  // 2 cm/s its sigmas are 0.02/(sqrt(2) sin 30) and 0.02/(2 cos 30) m/s.
  const Scene scene = RichScene();
  const Eigen::Vector3d v_d(1.3, 0.2, -0.1);
  const LinearizedMeasurement beams =
      scene.Evaluate({0.0, 0, false, Janus(v_d)});
  Dvl axes = ThreeAxis(v_d);
  const double level = 0.02 / (std::sqrt(2.0) * 0.5);
  axes.sigma.head<3>() = Eigen::Vector3d(level, level, 0.01 / std::sqrt(0.75));
  const LinearizedMeasurement three = scene.Evaluate({0.0, 0, false, axes});
  const auto information = [](const LinearizedMeasurement& z) {
    return ErrorMatrix(z.H.transpose() * z.R.inverse() * z.H);
  };
  const ErrorMatrix expected = information(three);
  EXPECT_LT((information(beams) - expected).norm(), 1e-12 * expected.norm());
}

TEST(Dvl, WaterTrackIsRelativeToTheCurrent) {
  // Along with the water: 0.5 m/s to the north is to the left.
  Dvl dvl = ThreeAxis(kTrueVelocity + Eigen::Vector3d(0.0, 0.5, 0.0));
  dvl.water = true;
  Scene scene = With(BlockKind::kCurrent, {0.5, 0.0, 0.0}, DvlHeadingEast());
  scene.sensor.scale = 0.0;
  LinearizedMeasurement z = scene.Evaluate({0.0, 0, false, dvl});
  EXPECT_LT(z.residual.norm(), 1e-12);
  EXPECT_LT((z.H.rightCols<3>() + z.H.middleCols<3>(3)).norm(), 1e-12);
  dvl.water = false;
  z = scene.Evaluate({0.0, 0, false, dvl});
  EXPECT_LT((z.residual - Eigen::Vector3d(0.0, 0.5, 0.0)).norm(), 1e-12);
  EXPECT_EQ(z.H.rightCols<3>().norm(), 0.0);
}

TEST(Dvl, LastingErrorsAddInTheirAxes) {
  // The bottom seems to drift to the south by 0.5 m/s: the log, heading east,
  // sees that to its right.
  const Eigen::Vector3d bias(0.01, -0.02, 0.03);
  Scene scene =
      With(BlockKind::kGroundBias, {-0.5, 0.0, 0.0}, DvlHeadingEast());
  scene = With(BlockKind::kBias, bias, scene);
  const Dvl dvl =
      ThreeAxis(1.02 * (kTrueVelocity + Eigen::Vector3d(0.0, 0.5, 0.0) + bias));
  LinearizedMeasurement z = scene.Evaluate({0.0, 0, false, dvl});
  EXPECT_LT(z.residual.norm(), 1e-12);
  EXPECT_LT((z.H.rightCols<3>() - 1.02 * Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  EXPECT_LT((z.H.middleCols<3>(z.H.cols() - 6) - z.H.middleCols<3>(3)).norm(),
            1e-12);
  // Through the water the bottom is not seen.
  Dvl water = ThreeAxis(1.02 * (kTrueVelocity + bias));
  water.water = true;
  z = scene.Evaluate({0.0, 0, false, water});
  EXPECT_LT(z.residual.norm(), 1e-12);
  EXPECT_EQ(z.H.middleCols<3>(z.H.cols() - 6).norm(), 0.0);
}

TEST(Dvl, AGaussMarkovStateIsSharedOutToTheAxes) {
  Scene scene = With(BlockKind::kBias, {0.3, 0.3, 0.3}, DvlHeadingEast());
  scene.sensor.scale = 0.0;
  scene.sensor.bias = {.sigma = Eigen::Vector3d(1e-3, 4e-3, 2e-3), .tau = 30.0};
  const Eigen::Vector3d share(0.25, 1.0, 0.5);
  const LinearizedMeasurement z =
      scene.Evaluate({0.0, 0, false, ThreeAxis(kTrueVelocity + 0.3 * share)});
  EXPECT_LT(z.residual.norm(), 1e-12);
  EXPECT_EQ(Eigen::Matrix3d(z.H.rightCols<3>()),
            Eigen::Matrix3d(share.asDiagonal()));
}

TEST(Dvl, LastingErrorsAreThoseOfTheSimulation) {
  const Eigen::Vector3d bias(0.01, -0.02, 0.03);
  const Eigen::Vector3d ground(0.04, 0.05, -0.06);
  Scene scene = With(BlockKind::kGroundBias, ground, DvlHeadingEast());
  scene = With(BlockKind::kBias, bias, scene);
  const Eigen::Matrix3d C_bn = (scene.state.q_eb.conjugate() *
                                Eigen::Quaterniond(NedAxes(scene.state.p_e)))
                                   .toRotationMatrix();
  for (const bool water : {false, true}) {
    for (const Dvl& perfect :
         {ThreeAxis(kTrueVelocity), Janus(kTrueVelocity)}) {
      MeasurementModel model = perfect;
      std::get<Dvl>(model).water = water;
      DvlKind().add_lasting(bias, C_bn * ground, &model);
      std::get<Dvl>(model).speed *= 1.02;
      EXPECT_LT(scene.Evaluate({0.0, 0, false, model}).residual.norm(), 1e-12);
    }
  }
}

TEST(Dvl, BoresightTurnsTheTransducer) {
  // Mounted 90 deg to the right, its forward is the body's right.
  Scene scene = DvlHeadingEast();
  scene.sensor.scale = 0.0;
  scene.sensor.q_sb = Exp(Eigen::Vector3d(0.0, 0.0, -90.0 * kDegree));
  const LinearizedMeasurement z =
      scene.Evaluate({0.0, 0, false, ThreeAxis({-0.3, -2.7, 0.2})});
  EXPECT_LT(z.residual.norm(), 1e-12);
}

TEST(Dvl, JacobianMatchesNumericDifference) {
  Scene scene = With(BlockKind::kCurrent, {0.4, -0.3, 0.1}, RichScene());
  scene = With(BlockKind::kBias, {0.05, -0.04, 0.03}, scene);
  scene = With(BlockKind::kGroundBias, {-0.3, 0.2, 0.1}, scene);
  Dvl three = ThreeAxis({9.0, 1.0, 2.0});
  Dvl beams = Janus({9.0, 1.0, 2.0});
  ExpectJacobian(scene, {0.0, 0, false, three}, "three axes");
  ExpectJacobian(scene, {0.0, 0, false, beams}, "beams");
  beams.valid = {false, true, true, false};
  ExpectJacobian(scene, {0.0, 0, false, beams}, "two beams");
  Scene wandering = scene;
  wandering.sensor.bias = {.sigma = Eigen::Vector3d(3e-3, 1e-3, 5e-4),
                           .tau = 30.0};
  wandering.sensor.ground_bias = {.sigma = Eigen::Vector3d(2e-3, 4e-3, 1e-3),
                                  .tau = 600.0};
  ExpectJacobian(wandering, {0.0, 0, false, three}, "Gauss-Markov");
  three.water = beams.water = true;
  ExpectJacobian(scene, {0.0, 0, false, three}, "three axes, water");
  ExpectJacobian(scene, {0.0, 0, false, beams}, "beams, water");
}

}  // namespace
}  // namespace hindsight
