#include "evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

TEST(Statistics, MatchHandComputedCase) {
  const ErrorStatistics s = ComputeStatistics({3.0, -4.0, 1.0, -2.0, 5.0});
  EXPECT_EQ(s.count, 5u);
  EXPECT_DOUBLE_EQ(s.mean, 0.6);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(11.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(11.0 - 0.36));
  EXPECT_DOUBLE_EQ(s.max, 5.0);
  EXPECT_DOUBLE_EQ(s.p50, 3.0);
  EXPECT_NEAR(s.p68, 3.72, 1e-12);
  EXPECT_NEAR(s.p95, 4.80, 1e-12);
  EXPECT_NEAR(s.p99, 4.96, 1e-12);
}

TEST(Statistics, OneErrorIsItsOwnPercentile) {
  const ErrorStatistics s = ComputeStatistics({-2.5});
  EXPECT_DOUBLE_EQ(s.p50, 2.5);
  EXPECT_DOUBLE_EQ(s.p99, 2.5);
  EXPECT_DOUBLE_EQ(s.std, 0.0);
}

TEST(Statistics, ScatterSurvivesALargeMean) {
  const ErrorStatistics s = ComputeStatistics({1e9 + 1.0, 1e9 - 1.0});
  EXPECT_DOUBLE_EQ(s.std, 1.0);
}

}  // namespace
}  // namespace hindsight
