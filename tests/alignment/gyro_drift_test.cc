#include "alignment/gyro_drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

StartReport Found(double walk) {
  StartReport report;
  report.gyro_bias_walk = walk;
  return report;
}

ImuNoise Stated(double walk) {
  ImuNoise noise;
  noise.gyro_bias_walk = walk;
  return noise;
}

TEST(GyroDrift, BeyondTheStatedWalkIsDoubtful) {
  const auto found = FindGyroDrift(Found(0.01 * kDegree), Stated(0.0));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->rule, "gyro_drift");
  EXPECT_EQ(found->grade, Grade::kDoubtful);
  EXPECT_NEAR(*found->value, 0.01 * std::sqrt(60.0), 1e-9);
  EXPECT_NE(found->remedies.at(0).find("gyro_bias_walk: 0.01 deg/s^2/sqrt(Hz)"),
            std::string::npos);
}

TEST(GyroDrift, AWalkThatLetsTheBiasFollowIsUsable) {
  EXPECT_FALSE(FindGyroDrift(Found(0.0), Stated(0.0)));
  EXPECT_FALSE(FindGyroDrift(Found(0.01 * kDegree), Stated(0.003 * kDegree)));
  EXPECT_TRUE(FindGyroDrift(Found(0.01 * kDegree), Stated(0.002 * kDegree)));
}

TEST(GyroDrift, NamesADropOutThatLosesTheAttitude) {
  const auto told = [](double sigma) {
    return FindGyroDrift(Found(0.01 * kDegree), Stated(0.0),
                         BridgedDropOut{60.0, 5.0, sigma});
  };
  EXPECT_NE(told(0.5)->causes.at(0).find("drop-out of 5 s at 60.0 s"),
            std::string::npos);
  EXPECT_EQ(told(0.1)->causes.at(0), "a gyro that warms up");
}

}  // namespace
}  // namespace hindsight
