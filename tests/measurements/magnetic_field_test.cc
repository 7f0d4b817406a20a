#include "measurements/magnetic_field.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::Scene;

constexpr double kDeclination = 5.0 * kDegree;

Measurement Reading(MagneticField::Form form, const Eigen::Vector3d& field_b) {
  return {0.0, 0, false, MagneticField{field_b, 0.4, form}};
}

/// Level, heading east, field 20 uT towards 5 deg east of north and 40 uT down.
Scene MagnetometerHeadingEast() {
  Scene scene;
  scene.state = MakeState(0.0, {0.9, 0.2, 10.0}, {1.0, 2.0, 0.5},
                          {0.0, 0.0, 90.0 * kDegree});
  scene.sensor.kind = &MagnetometerKind();
  scene.sensor.magnetic.declination = kDeclination;
  return scene;
}

/// Attitude anyhow, 70 ms before the measurement, every block it knows.
Scene RichMagneticScene() {
  Scene scene = testing::RichScene();
  const auto add = [&scene](BlockKind kind, const Eigen::Vector3d& value) {
    Block block;
    block.key = {kind, 0};
    block.name = "block";
    block.unit = "1";
    block.sigma0.setOnes();
    scene.layout.Add(block);
    const int dim = FullDimension(kind);
    const ParameterVector before = scene.state.parameters;
    scene.state.parameters.setZero(scene.layout.parameter_count());
    scene.state.parameters.head(before.size()) = before;
    scene.state.parameters.tail(dim) = value.head(dim);
  };
  add(BlockKind::kHardIron, {3.0, -2.0, 5.0});
  add(BlockKind::kDeclination, {0.1, 0.0, 0.0});
  add(BlockKind::kDisturbance, {-4.0, 2.0, 6.0});
  scene.sensor.kind = &MagnetometerKind();
  return scene;
}

TEST(MagneticField, VectorAtHeading90Degrees) {
  Scene scene = MagnetometerHeadingEast();
  scene.sensor.magnetic.hard_iron_b = {1.0, 2.0, 3.0};
  // Forward is east, right is south.
  const Eigen::Vector3d expected(20.0 * std::sin(kDeclination) + 1.0,
                                 -20.0 * std::cos(kDeclination) + 2.0, 43.0);
  const Eigen::Vector3d error(0.1, -0.2, 0.3);
  const LinearizedMeasurement z =
      scene.Evaluate(Reading(MagneticField::Form::kVector, expected + error));
  ASSERT_EQ(z.residual.size(), 3);
  EXPECT_LT((z.residual - error).norm(), 1e-12);
  EXPECT_LT((z.R - 0.16 * Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

TEST(MagneticField, HeadingIsTheAngleFromMagneticNorth) {
  const Scene scene = MagnetometerHeadingEast();
  // The field lies 88 deg left of the nose: the magnetic heading is 88 deg, the
  // true one 93 deg where the state says 90 deg.
  const double left = 88.0 * kDegree;
  const LinearizedMeasurement z = scene.Evaluate(
      Reading(MagneticField::Form::kHeading,
              {30.0 * std::cos(left), -30.0 * std::sin(left), 55.0}));
  ASSERT_EQ(z.residual.size(), 1);
  EXPECT_NEAR(z.residual(0), 3.0 * kDegree, 1e-12);
  EXPECT_NEAR(z.H(0, 8), 1.0, 1e-12);
  EXPECT_NEAR(z.R(0, 0), std::pow(0.4 / 20.0, 2), 1e-12);
}

TEST(MagneticField, HeadingTakesTheShortWayAround) {
  Scene scene = MagnetometerHeadingEast();
  scene.sensor.magnetic.declination = 0.0;
  scene.state = MakeState(0.0, {0.9, 0.2, 10.0}, Eigen::Vector3d::Zero(),
                          {0.0, 0.0, 179.0 * kDegree});
  const double heading = -179.0 * kDegree;
  const LinearizedMeasurement z = scene.Evaluate(
      Reading(MagneticField::Form::kHeading,
              {20.0 * std::cos(heading), -20.0 * std::sin(heading), 40.0}));
  EXPECT_NEAR(z.residual(0), 2.0 * kDegree, 1e-12);
}

TEST(MagneticField, ResidualVanishesAtTheTruth) {
  Scene scene = RichMagneticScene();
  // At the node: beside it the forms are linear in the offset, each by itself.
  scene.stamp = scene.state.t - 0.05;
  const LinearizedMeasurement vector = scene.Evaluate(
      Reading(MagneticField::Form::kVector, Eigen::Vector3d::Zero()));
  const Eigen::Vector3d predicted = -vector.residual;
  EXPECT_NEAR(scene.Evaluate(Reading(MagneticField::Form::kHeading, predicted))
                  .residual(0),
              0.0, 1e-12);
}

TEST(MagneticField, JacobianMatchesNumericDifference) {
  const Scene scene = RichMagneticScene();
  const Eigen::Vector3d field_b(11.0, -25.0, 30.0);
  ExpectJacobian(scene, Reading(MagneticField::Form::kVector, field_b),
                 "vector");
  ExpectJacobian(scene, Reading(MagneticField::Form::kHeading, field_b),
                 "heading");
}

/// Appends an error of the sensor beyond its noise.
void AddError(const Eigen::Vector3d& value, Scene* scene) {
  Block block;
  block.key = {BlockKind::kSensorError, 0};
  block.name = "error";
  scene->layout.Add(block);
  ParameterVector& values = scene->state.parameters;
  values.conservativeResize(scene->layout.parameter_count());
  values.tail<3>() = value;
}

TEST(MagneticField, AnErrorIsAFieldOfTheVehicle) {
  const Eigen::Vector3d field_b(11.0, -25.0, 30.0);
  const Eigen::Vector3d error_b(2.0, -1.0, 4.0);
  for (const auto form :
       {MagneticField::Form::kVector, MagneticField::Form::kHeading}) {
    Scene scene = RichMagneticScene();
    const RowVector without = scene.Evaluate(Reading(form, field_b)).residual;
    AddError(error_b, &scene);
    const Measurement z = Reading(form, field_b + error_b);
    EXPECT_LT((scene.Evaluate(z).residual - without).norm(), 1e-12);
    ExpectJacobian(scene, z, "with an error");
  }
}

TEST(MagneticField, AnErrorBesideAKnownHardIronIsOfTheAzimuth) {
  Scene scene = testing::RichScene();
  scene.sensor.kind = &MagnetometerKind();
  const Measurement z =
      Reading(MagneticField::Form::kHeading, {11.0, -25.0, 30.0});
  const double without = scene.Evaluate(z).residual(0);
  AddError({3.0, 0.0, 0.0}, &scene);
  EXPECT_NEAR(scene.Evaluate(z).residual(0),
              std::remainder(without - 3.0, 2.0 * kPi), 1e-12);
  ExpectJacobian(scene, z, "azimuth with an error");
}

TEST(MagneticField, SigmaIsScaled) {
  Measurement z = Reading(MagneticField::Form::kVector, {20.0, 0.0, 40.0});
  ScaleSigma(3.0, &z);
  EXPECT_DOUBLE_EQ(std::get<MagneticField>(z.model).sigma, 1.2);
}

}  // namespace
}  // namespace hindsight
