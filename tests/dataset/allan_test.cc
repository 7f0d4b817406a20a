#include "dataset/allan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hindsight {
namespace {

constexpr double kDt = 0.02;

/// Readings of white noise of density N about a bias that walks with density K.
std::vector<double> StillReadings(double white, double walk, std::size_t count,
                                  Random* random) {
  std::vector<double> x(count);
  double bias = 0.0;
  for (double& value : x) {
    value = bias + white / std::sqrt(kDt) * random->Normal();
    bias += walk * std::sqrt(kDt) * random->Normal();
  }
  return x;
}

TEST(Allan, OfTwoClustersIsHalfTheSquareOfTheirDifference) {
  // m = 1 of x = 1, 3, 1, 3 ...: neighbours differ by 2, sigma^2 = 2^2 / 2.
  std::vector<double> x;
  for (int i = 0; i < 40; ++i) x.push_back(i % 2 == 0 ? 1.0 : 3.0);
  const auto points = AllanDeviation(x, kDt);
  ASSERT_FALSE(points.empty());
  EXPECT_EQ(points[0].tau, kDt);
  EXPECT_NEAR(points[0].deviation, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(points[0].log_sigma, 1.0 / std::sqrt(2.0 * 39.0), 1e-12);
  // Clusters of two are all alike.
  EXPECT_NEAR(points[1].deviation, 0.0, 1e-12);
}

TEST(Allan, DensitiesOfRestComeBackWithinTenPercentOverSeeds) {
  constexpr double kWhite = 2e-3;
  constexpr double kWalk = 4e-4;
  constexpr int kSeeds = 20;
  constexpr std::size_t kCount = 90000;  // half an hour
  double white = 0.0;
  double walk = 0.0;
  double squares = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(7000 + static_cast<std::uint64_t>(seed));
    const AllanFit fit = FitAllan(
        AllanDeviation(StillReadings(kWhite, kWalk, kCount, &random), kDt));
    EXPECT_NEAR(fit.white.value, kWhite, 0.1 * kWhite) << seed;
    white += fit.white.value / kSeeds;
    walk += fit.walk.value / kSeeds;
    squares += std::pow((fit.walk.value - kWalk) / fit.walk.sigma, 2) / kSeeds;
  }
  EXPECT_NEAR(white, kWhite, 0.1 * kWhite);
  EXPECT_NEAR(walk, kWalk, 0.1 * kWalk);
  // The sigma of the walk is of the size of its errors: 20 squares of unit
  // variance have a mean within 0.3 and 2.2 but for one in a thousand.
  EXPECT_GT(squares, 0.3);
  EXPECT_LT(squares, 2.2);
}

TEST(Allan, WhiteNoiseAloneHasNoWalkBeyondItsSigma) {
  Random random(7101);
  const AllanFit fit =
      FitAllan(AllanDeviation(StillReadings(1e-3, 0.0, 50000, &random), kDt));
  EXPECT_LT(fit.walk.value, 4.0 * fit.walk.sigma);
  EXPECT_NEAR(fit.white.value, 1e-3, 5.0 * fit.white.sigma);
}

TEST(Allan, TooFewSamplesHaveNone) {
  EXPECT_TRUE(AllanDeviation(std::vector<double>(29, 1.0), kDt).empty());
}

}  // namespace
}  // namespace hindsight
