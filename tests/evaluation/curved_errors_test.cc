#include "evaluation/curved_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// Dead reckoned 600 m to the north by a heading known to `heading_sigma`, the
/// distance known to a metre.
Solution NorthBound(double heading_sigma, bool forward) {
  constexpr double kDistance = 600.0;
  constexpr int kNodes = 4;
  Solution solution;
  solution.method = "batch";
  solution.forward = forward;
  solution.layout = NavigationLayout({});
  const int dim = solution.layout.dim();
  const int p = solution.layout.Find(BlockKind::kPosition)->offset;
  const int h = solution.layout.Find(BlockKind::kAttitude)->offset + 2;
  solution.covariances = CovarianceSeries(dim, kNodes);
  for (int k = 0; k < kNodes; ++k) {
    State x;
    x.t = k;
    solution.states.push_back(x);
    const double r = kDistance * k / (kNodes - 1);
    ErrorMatrix P = 1e-2 * ErrorMatrix::Identity(dim, dim);
    const double variance = heading_sigma * heading_sigma;
    P(h, h) = variance;
    P(p, p) = 1.0;
    P(p + 1, p + 1) = 1.0 + r * r * variance;
    P(p + 1, h) = P(h, p + 1) = r * variance;
    solution.covariances.Set(static_cast<std::size_t>(k), P);
  }
  return solution;
}

std::vector<Evidence> Found(const Solution& solution) {
  std::vector<Evidence> evidence;
  FindCurvedErrors({.solution = solution}, &evidence);
  return evidence;
}

/// The errors across are what turning the way by a random angle makes of them.
TEST(CurvedErrors, AreThoseOfTurnedWays) {
  constexpr double kSigma = 8.0 * kDegree;
  const std::vector<Evidence> evidence = Found(NorthBound(kSigma, false));
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_THAT(evidence[0].what, HasSubstr("a heading known to 8 deg"));
  EXPECT_EQ(evidence[0].t_begin, 3.0);
  Random random(5);
  double sum = 0.0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double along = 600.0 * (1.0 - std::cos(kSigma * random.Normal()));
    const double other = random.Normal();
    sum += along * along + other * other;
  }
  const double e = std::sqrt(sum / kDraws);
  EXPECT_NEAR(evidence[0].value.value(), e, 0.03 * e);
}

TEST(CurvedErrors, AreNoneOfAHeadingThatIsKnown) {
  EXPECT_TRUE(Found(NorthBound(2.0 * kDegree, false)).empty());
  EXPECT_TRUE(Found(NorthBound(0.0, false)).empty());
}

/// A filter that learns where it is says so at the end: the root mean square
/// over the interval counts, 3.5 at 600 m, of which two nodes have less.
TEST(CurvedErrors, OfAFilterCountOverTheInterval) {
  const std::vector<Evidence> smoother =
      Found(NorthBound(4.0 * kDegree, false));
  const std::vector<Evidence> filter = Found(NorthBound(4.0 * kDegree, true));
  ASSERT_EQ(smoother.size(), 1u);
  ASSERT_EQ(filter.size(), 1u);
  const double largest = smoother[0].value.value();
  // Excesses go with the square of the distance: 0, 1/9, 4/9 and 1.
  EXPECT_NEAR(filter[0].value.value(),
              std::sqrt(1.0 + (largest * largest - 1.0) * 14.0 / 36.0), 1e-9);
}

}  // namespace
}  // namespace hindsight
