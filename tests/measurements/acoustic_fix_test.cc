#include "measurements/acoustic_fix.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

/// Heading east; the array 2 m to the right of the IMU, which is to the south.
Scene HeadingEast() {
  Scene scene;
  scene.state = MakeState(0.0, {0.0, 0.0, 0.0}, {0.0, 2.0, 0.0},
                          {0.0, 0.0, 90.0 * kDegree});
  scene.sensor.lever_arm_b = {0.0, 2.0, 0.0};
  return scene;
}

/// A place `d_n` (NED) from the state.
Eigen::Vector3d Place(const Scene& scene, const Eigen::Vector3d& d_n) {
  return scene.state.p_e + scene.state.C_en() * d_n;
}

TEST(AcousticFix, RangeAndBearingByHand) {
  const Scene scene = HeadingEast();
  // From the array: 40 m north, 30 m east: to the left, azimuth -53.13 deg.
  AcousticFix fix;
  fix.has_bearing = true;
  fix.p_t_e = Place(scene, {38.0, 30.0, 0.0});
  fix.range = 50.5;
  fix.azimuth = std::atan2(-40.0, 30.0) + 0.01;
  fix.depression = -0.02;
  fix.sigma_range = 0.5;
  fix.sigma_bearing = 0.1;
  const LinearizedMeasurement z = scene.Evaluate({0.0, 0, false, fix});
  ASSERT_EQ(z.residual.size(), 3);
  EXPECT_NEAR(z.residual(0), 0.5, 1e-9);
  EXPECT_NEAR(z.residual(1), 0.01, 1e-5);
  EXPECT_NEAR(z.residual(2), -0.02, 1e-5);
  EXPECT_LT((z.R.diagonal() - Eigen::Vector3d(0.25, 0.01, 0.01)).norm(), 1e-15);
  // Nearer to the transponder the range shrinks: along (0.8, 0.6, 0).
  EXPECT_LT((z.H.block<1, 3>(0, 0) + Eigen::RowVector3d(0.8, 0.6, 0.0)).norm(),
            1e-7);
}

TEST(AcousticFix, RowsAreThoseMeasured) {
  AcousticFix fix;
  EXPECT_EQ(fix.rows(), 1);
  fix.has_bearing = true;
  EXPECT_EQ(fix.rows(), 3);
  fix.has_range = false;
  EXPECT_EQ(fix.rows(), 2);
}

TEST(AcousticFix, JacobianMatchesNumericDifference) {
  const Scene scene = RichScene();
  AcousticFix fix;
  fix.p_t_e = Place(scene, {1000.0, -1600.0, 480.0});
  ExpectJacobian(scene, {0.0, 0, false, fix}, "range");
  // Straight below, where azimuth has no derivative.
  fix.has_bearing = true;
  fix.p_t_e = Place(scene, {1.0, -2.0, 300.0});
  fix.azimuth = 0.4;
  fix.depression = 89.0 * kDegree;
  ExpectJacobian(scene, {0.0, 0, false, fix}, "range and bearing");
  fix.has_range = false;
  ExpectJacobian(scene, {0.0, 0, false, fix}, "bearing");
}

}  // namespace
}  // namespace hindsight
