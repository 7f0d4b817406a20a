#include "imu/worst_drop_out.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hindsight {
namespace {

/// 100 Hz over 60 s at rest, turning by `rate` [rad/s] from 30 s on, without
/// what lies in (from, from + length).
ImuStream Stream(double from, double length, double rate = 0.0) {
  ImuStream imu;
  imu.nominal_dt = 0.01;
  for (int i = 0; i <= 6000; ++i) {
    const double t = 0.01 * i;
    if (t > from + 1e-6 && t < from + length - 1e-6) continue;
    imu.samples.push_back(
        {t,
         t < 30.0 ? Eigen::Vector3d::Zero()
                  : Eigen::Vector3d(rate * Eigen::Vector3d::UnitZ()),
         {0.0, 0.0, -9.8}});
  }
  return imu;
}

TEST(WorstDropOut, IsLostAsItsBridgeSays) {
  const auto at_rest = WorstDropOut(Stream(20.0, 5.0), 0.0, 60.0);
  ASSERT_TRUE(at_rest);
  EXPECT_NEAR(at_rest->t, 20.0, 1e-9);
  EXPECT_NEAR(at_rest->length, 5.0, 1e-9);
  // 0.1 rad/s all along, or the readings' difference.
  EXPECT_NEAR(at_rest->attitude_sigma, 0.5, 1e-9);
  const auto turning = WorstDropOut(Stream(28.0, 5.0, 0.4), 0.0, 60.0);
  EXPECT_NEAR(turning->attitude_sigma, 2.0, 1e-9);
  EXPECT_EQ(LostAttitude(at_rest),
            "the IMU's drop-out of 5 s at 20.0 s, in which the attitude is "
            "lost to 29 deg");
}

TEST(WorstDropOut, IsNoneWithoutOneOrOutsideOfTheInterval) {
  EXPECT_FALSE(WorstDropOut(Stream(100.0, 0.0), 0.0, 60.0));
  EXPECT_FALSE(WorstDropOut(Stream(20.0, 5.0), 26.0, 60.0));
  EXPECT_FALSE(LostAttitude(std::nullopt));
  EXPECT_FALSE(LostAttitude(WorstDropOut(Stream(20.0, 3.0), 0.0, 60.0)));
}

}  // namespace
}  // namespace hindsight
