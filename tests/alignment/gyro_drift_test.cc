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

}  // namespace
}  // namespace hindsight
