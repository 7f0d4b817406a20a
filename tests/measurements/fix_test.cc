#include <gtest/gtest.h>

#include "measurements/noise_kind.h"
#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

constexpr double kYawRate = 0.2;

/// On the equator at longitude zero, heading east: e axes are up, east, north;
/// body axes forward, right, down are east, south, down.
Scene FixHeadingEast(double pitch = 0.0) {
  Scene scene;
  scene.state = MakeState(0.0, {0.0, 0.0, 10.0}, {1.0, 10.0, 0.5},
                          {0.0, pitch, 90.0 * kDegree});
  scene.state.b_g = {0.01, 0.02, 0.03};
  const Eigen::Vector3d w_ie_b = scene.state.q_eb.conjugate() * EarthRate_e();
  scene.kinematics.w_ib_b =
      w_ie_b + Eigen::Vector3d(0.0, 0.0, kYawRate) + scene.state.b_g;
  scene.sensor.lever_arm_b = {2.0, 3.0, -1.0};
  return scene;
}

Measurement Position(const Eigen::Vector3d& p_e) {
  PositionFix fix;
  fix.p_e = p_e;
  fix.R_n = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  return {0.0, 0, false, fix};
}

Measurement Velocity(const Eigen::Vector3d& v_n) {
  VelocityFix fix;
  fix.v_n = v_n;
  fix.R_n = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  return {0.0, 0, false, fix};
}

Measurement Height(double height) {
  return {0.0, 0, false, HeightFix{height, 0.5}};
}

TEST(PositionFix, LeverArmAtHeading90Degrees) {
  const Scene scene = FixHeadingEast();
  // Antenna 3 m south, 2 m east, 1 m up.
  const Eigen::Vector3d antenna(kEarthSemiMajorAxis + 11.0, 2.0, -3.0);
  const LinearizedMeasurement exact = scene.Evaluate(Position(antenna));
  EXPECT_LT(exact.residual.norm(), 3e-9);  // rounding of 6.4e6 m
  const LinearizedMeasurement z =
      scene.Evaluate(Position(antenna + Eigen::Vector3d(-0.25, 0.5, 0.125)));
  // NED axes of the measured position are turned by 5e-7 rad.
  EXPECT_LT((z.residual - Eigen::Vector3d(0.125, 0.5, 0.25)).norm(), 5e-7);
  // A turn to the right moves the antenna by (0, 0, 1) x (-3, 2, -1).
  EXPECT_LT((z.H.col(8) - Eigen::Vector3d(-2.0, -3.0, 0.0)).norm(), 5e-6);
  EXPECT_LT((z.H.leftCols<3>() - Eigen::Matrix3d::Identity()).norm(), 2e-6);
  EXPECT_TRUE(z.H.middleCols<3>(3).isZero());
  EXPECT_TRUE(z.H.rightCols<6>().isZero());
  EXPECT_EQ(z.R, RowMatrix(Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal()));
}

TEST(PositionFix, ColouredNoiseAdds) {
  Scene scene = RichScene();
  const Measurement z = Position(scene.state.p_e);
  const Block& noise = *scene.layout.Find(BlockKind::kColouredNoise, 0);
  const RowVector with = scene.Evaluate(z).residual;
  scene.state.parameters.segment<3>(noise.parameter_offset).setZero();
  const RowVector difference = scene.Evaluate(z).residual - with;
  EXPECT_LT((difference - Eigen::Vector3d(0.3, -0.2, 0.5)).norm(), 3e-9);
}

TEST(PositionFix, JacobianMatchesNumericDifference) {
  const Scene scene = RichScene();
  ExpectJacobian(scene, Position(scene.state.p_e + Eigen::Vector3d(3, -2, 1)),
                 "position");
}

TEST(VelocityFix, LeverArmAtHeading90Degrees) {
  const Scene scene = FixHeadingEast();
  // Yaw rate times lever arm: 0.6 m/s west, 0.4 m/s north... of the forward
  // (-0.6) and right (0.4) components at heading east.
  const LinearizedMeasurement z =
      scene.Evaluate(Velocity({1.0 - 0.4, 10.0 - 0.6, 0.5}));
  EXPECT_LT(z.residual.norm(), 1e-12);
  EXPECT_LT((z.H.middleCols<3>(3) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  // A bias of the vertical gyro: l x (0, 0, 1) = (3, -2, 0) in body axes.
  EXPECT_LT((z.H.col(11) - Eigen::Vector3d(2.0, 3.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(z.R, RowMatrix(Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal()));
}

TEST(VelocityFix, JacobianMatchesNumericDifference) {
  ExpectJacobian(RichScene(), Velocity({11.0, -6.0, 0.3}), "velocity");
}

TEST(HeightFix, LeverArmAtHeading90Degrees) {
  const Scene scene = FixHeadingEast(30.0 * kDegree);
  // Nose up by 30 deg: forward 2 m gives 1 m, down -1 m gives cos 30 deg.
  const double up = 10.0 + 1.0 + std::sqrt(0.75);
  const LinearizedMeasurement z = scene.Evaluate(Height(up + 0.25));
  // The ellipsoid falls off by (l^2/2)/R over the lever arm of 3.5 m.
  EXPECT_NEAR(z.residual(0), 0.25, 1.1e-6);
  EXPECT_NEAR(z.H(0, 2), -1.0, 1e-9);
  EXPECT_EQ(z.R(0, 0), 0.25);
  // Nose further up (psi about south, psi_n = -1): forward part of the arm
  // 2 cos 30 deg, its vertical part turns back by (-1) sin 30 deg.
  EXPECT_NEAR(z.H(0, 6), -(2.0 * std::sqrt(0.75) - 0.5), 5e-6);
}

TEST(HeightFix, OffsetAdds) {
  Scene scene = RichScene();
  const Block& offset = *scene.layout.Find(BlockKind::kOffset, 0);
  const double with = scene.Evaluate(Height(50.0)).residual(0);
  scene.state.parameters(offset.parameter_offset) = 0.0;
  EXPECT_NEAR(scene.Evaluate(Height(50.0)).residual(0) - with, 0.7, 3e-9);
}

TEST(HeightFix, JacobianMatchesNumericDifference) {
  ExpectJacobian(RichScene(), Height(51.0), "height");
}

TEST(Fixes, WithoutTimeOffsetStateTheStampIsNotLookedAt) {
  // The node stands at stamp + time offset: nothing may move it again.
  Scene scene = FixHeadingEast();
  scene.stamp = 5.0;
  const Eigen::Vector3d antenna(kEarthSemiMajorAxis + 11.0, 2.0, -3.0);
  EXPECT_LT(scene.Evaluate(Position(antenna)).residual.norm(), 3e-9);
}

/// What stands as states is not noise a second time.
TEST(ColouredNoise, TakesThePlaceOfTheStatedCovariance) {
  Scene scene = RichScene();
  const LinearizedMeasurement beside =
      scene.Evaluate(Position(scene.state.p_e));
  EXPECT_EQ(beside.R(1, 1), 4.0);
  scene.sensor.noise.kind = &GaussMarkovNoise();
  scene.sensor.noise.white_sigma = 0.2;
  for (const Measurement& z :
       {Position(scene.state.p_e), Velocity(Eigen::Vector3d(1.0, 2.0, 3.0))}) {
    const LinearizedMeasurement white = scene.Evaluate(z);
    EXPECT_LT((white.R - 0.04 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Block* block = scene.layout.Find(BlockKind::kColouredNoise, 0);
    EXPECT_TRUE(white.H.middleCols(block->offset, 3).isIdentity());
  }
}

/// Errors beyond the noise add to the noise's own, and have columns of their own.
TEST(SensorError, AddsToColouredNoise) {
  Scene scene = RichScene();
  const RowVector before = scene.Evaluate(Position(scene.state.p_e)).residual;
  Block block;
  block.key = {BlockKind::kSensorError, 0};
  block.name = "gnss_error";
  scene.layout.Add(block);
  ParameterVector& values = scene.state.parameters;
  values.conservativeResize(scene.layout.parameter_count());
  values.tail<3>() << 4.0, 5.0, -6.0;
  const Measurement z = Position(scene.state.p_e);
  const LinearizedMeasurement at = scene.Evaluate(z);
  const Eigen::Vector3d added(4.0, 5.0, -6.0);
  EXPECT_LT((before - at.residual - added).norm(), 1e-8);
  const int noise = scene.layout.Find(BlockKind::kColouredNoise, 0)->offset;
  EXPECT_TRUE(at.H.middleCols(noise, 3).isIdentity());
  EXPECT_TRUE(at.H.rightCols(3).isIdentity());
  ExpectJacobian(scene, z, "position with both");
}

TEST(ColouredNoise, LeavesAMaskedAxisItsCovariance) {
  Scene scene = RichScene();
  ErrorLayout masked;
  for (Block block : scene.layout.blocks()) {
    if (block.key.kind == BlockKind::kColouredNoise) block.active[2] = false;
    masked.Add(block);
  }
  scene.layout = masked;
  scene.sensor.noise.kind = &GaussMarkovNoise();
  scene.sensor.noise.white_sigma = 0.0;
  const LinearizedMeasurement z = scene.Evaluate(Position(scene.state.p_e));
  EXPECT_LT((z.R - Eigen::Matrix3d(Eigen::Vector3d(0.0, 0.0, 9.0).asDiagonal()))
                .norm(),
            1e-12);
}

}  // namespace
}  // namespace hindsight
