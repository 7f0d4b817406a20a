#include "problems/iteration_progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hindsight {
namespace {

TEST(IterationProgress, TimeLeftIsThatOfTheIterationsToCome) {
  // Steps that shrink by ten each time, below the limit after seven.
  std::vector<double> fractions;
  IterationProgress progress([&](double f) { fractions.push_back(f); });
  progress.Begin(50, 0.0);
  for (int i = 0; i <= 7; ++i) progress.After(i, 2e6 * std::pow(10.0, -i));
  ASSERT_EQ(fractions.size(), 8u);
  EXPECT_EQ(fractions[0], 0.0);
  for (int i = 2; i <= 7; ++i) {
    // seconds (1 - f) / f, with a second an iteration.
    const double f = fractions[static_cast<std::size_t>(i)];
    EXPECT_NEAR(i * (1.0 - f) / f, 7 - i, 1e-9) << i;
  }
}

TEST(IterationProgress, CountsWhatComesLaterAndNeverGoesBack) {
  std::vector<double> fractions;
  IterationProgress progress([&](double f) { fractions.push_back(f); });
  progress.Begin(2, 6.0);
  progress.After(0, 0.0);
  progress.After(1, 1e9);
  // At most one more here, then six.
  EXPECT_NEAR(fractions.back(), 1.0 / 8.0, 1e-12);
  progress.After(2, 1e9);
  EXPECT_NEAR(fractions.back(), 2.0 / 8.0, 1e-12);
  progress.Begin(50, 40.0);
  progress.After(1, 1e9);
  EXPECT_NEAR(fractions.back(), 2.0 / 8.0, 1e-12);
}

}  // namespace
}  // namespace hindsight
