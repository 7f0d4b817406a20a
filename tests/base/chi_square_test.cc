#include "base/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace hindsight {
namespace {

TEST(ChiSquare, QuantilesMatchPublishedTable) {
  // NIST/SEMATECH e-Handbook, section 1.3.6.7.4, three decimals.
  EXPECT_NEAR(ChiSquareQuantile(0.95, 1), 3.841, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.95, 3), 7.815, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.99, 3), 11.345, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.999, 6), 22.458, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.05, 10), 3.940, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.975, 100), 129.561, 5e-4);
}

TEST(ChiSquare, TwoDegreesOfFreedomAreExponential) {
  for (const double p : {1e-6, 0.1, 0.5, 0.95, 1.0 - 1e-9}) {
    const double expected = -2.0 * std::log1p(-p);
    EXPECT_NEAR(ChiSquareQuantile(p, 2), expected, 1e-9 * expected);
  }
}

TEST(WeightedChiSquare, OfEqualWeightsIsChiSquare) {
  for (const int count : {1, 2, 3, 10, 300}) {
    const std::vector<double> weights(static_cast<std::size_t>(count), 2.5);
    for (const double tail : {0.3, 0.05, 1e-3, 1e-6, 1e-9}) {
      const double x = WeightedChiSquareQuantile(weights, tail) / 2.5;
      const double least = ChiSquareQuantile(1.0 - 1.1 * tail, count);
      const double most = ChiSquareQuantile(1.0 - 0.9 * tail, count);
      EXPECT_GT(x, least) << count << " " << tail;
      EXPECT_LT(x, most) << count << " " << tail;
    }
  }
}

/// Of weights that come in pairs, a sum of exponential variables: P(> x) =
/// sum over i of exp(-x / 2 l_i) product over j of l_i / (l_i - l_j).
TEST(WeightedChiSquare, OfPairsHasTheTailOfASumOfExponentials) {
  const std::vector<double> pairs = {22.5, 4.3, 1.7, 0.1};
  std::vector<double> weights = {0.0, -1.0};  // left out
  for (const double weight : pairs) weights.insert(weights.end(), 2, weight);
  for (const double tail : {0.3, 0.01, 3e-4, 1e-6}) {
    const double x = WeightedChiSquareQuantile(weights, tail);
    double sum = 0.0;
    for (const double own : pairs) {
      double factor = std::exp(-0.5 * x / own);
      for (const double other : pairs) {
        if (other != own) factor *= own / (own - other);
      }
      sum += factor;
    }
    EXPECT_NEAR(sum, tail, 0.1 * tail);
  }
  EXPECT_EQ(WeightedChiSquareQuantile({}, 0.01), 0.0);
}

TEST(ChiSquare, ManyDegreesOfFreedomAgreeWithThePoissonSum) {
  // P(chi^2_{2m} > x) = P(Poisson(x/2) < m).
  constexpr int m = 50000;
  for (const double p : {0.025, 0.5, 0.975}) {
    const double x = ChiSquareQuantile(p, 2.0 * m);
    double upper_tail = 0.0;
    for (int k = 0; k < m; ++k) {
      upper_tail +=
          std::exp(k * std::log(0.5 * x) - 0.5 * x - std::lgamma(k + 1.0));
    }
    EXPECT_NEAR(upper_tail, 1.0 - p, 1e-7);
    EXPECT_NEAR(ChiSquareCdf(x, 2.0 * m), p, 1e-9);
  }
}

TEST(ChiSquare, RejectsProbabilitiesAndDegreesOfFreedomOutOfRange) {
  EXPECT_THROW(ChiSquareQuantile(-0.1, 3), std::domain_error);
  EXPECT_THROW(ChiSquareQuantile(0.5, 0.0), std::domain_error);
}

TEST(AneesBounds, AreThoseOfTheAverage) {
  // chi^2 with 150 degrees of freedom: 117.985 and 185.800.
  const Interval bounds = AneesBounds(50, 3, 0.95);
  EXPECT_NEAR(bounds.lower, 117.985 / 50.0, 1e-5);
  EXPECT_NEAR(bounds.upper, 185.800 / 50.0, 1e-5);
  EXPECT_TRUE(bounds.Contains(3.0));
  EXPECT_FALSE(bounds.Contains(2.3));
  EXPECT_FALSE(bounds.Contains(3.8));
}

}  // namespace
}  // namespace hindsight
