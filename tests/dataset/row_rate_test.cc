#include "dataset/row_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/chi_square.h"
#include "evaluation/statistics.h"
#include "support/seed_count.h"
#include "support/walking_foot.h"

namespace hindsight {
namespace {

using testing::Steps;
using testing::Walk;
using testing::WalkRows;

TEST(RowRate, OfExactRowsIsTheirs) {
  for (const double rate : {60.0, 83.0, 200.0}) {
    const WalkRows rows = Steps({.rate = rate}, 1);
    const auto found = FindRowRate(rows.accel, rows.gyro);
    ASSERT_TRUE(found);
    EXPECT_GE(found->spans, 38u);
    EXPECT_NEAR(found->rate, rate, 2e-3 * rate);
  }
}

TEST(RowRate, SigmaIsThatOfItsScatter) {
  constexpr int kRuns = testing::SeedCount(40);
  const Walk walk = {.force_noise = 0.01, .rate_noise = 0.05};
  std::vector<double> errors, sigmas;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const WalkRows rows = Steps(walk, static_cast<std::uint64_t>(seed));
    const auto found = FindRowRate(rows.accel, rows.gyro);
    ASSERT_TRUE(found) << seed;
    errors.push_back(std::log(found->rate / walk.rate));
    sigmas.push_back(found->log_sigma);
  }
  const double mean = Mean(errors);
  double sum = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum += std::pow((errors[k] - mean) / sigmas[k], 2);
  }
  EXPECT_TRUE(AneesBounds(kRuns - 1, 1, 0.999).Contains(sum / (kRuns - 1)))
      << sum / (kRuns - 1);
  EXPECT_LT(std::abs(mean), 5e-3);
}

TEST(RowRate, IsNotToldWhereNothingTurns) {
  const WalkRows level =
      Steps({.swing = 0.0, .force_noise = 0.01, .rate_noise = 0.05}, 1);
  EXPECT_FALSE(FindRowRate(level.accel, level.gyro));
  EXPECT_FALSE(FindRowRate({}, {}));
}

}  // namespace
}  // namespace hindsight
