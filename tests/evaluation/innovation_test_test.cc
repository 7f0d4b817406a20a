#include "evaluation/innovation_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "base/chi_square.h"
#include "base/random.h"

namespace hindsight {
namespace {

constexpr double kAlarms = 0.01;

/// Innovations of two sensors, of 3 rows and of 1, a second apart.
std::vector<NormalisedInnovation> Draw(
    int count, std::uint64_t seed,
    const std::function<double(int k, double white)>& first_row) {
  Random random(seed, 1);
  std::vector<NormalisedInnovation> all;
  for (int k = 0; k < count; ++k) {
    Eigen::Vector3d rows = random.NormalVector3();
    rows.x() = first_row(k, rows.x());
    const auto index = static_cast<std::size_t>(k);
    all.push_back({1.0 * k, 0, index, rows, rows});
    const RowVector row = RowVector::Constant(1, random.Normal());
    all.push_back({1.0 * k, 1, index, row, row});
  }
  return all;
}

double LargestExcess(const std::vector<InnovationFigure>& figures) {
  double largest = 0.0;
  for (const InnovationFigure& figure : figures) {
    largest = std::max(largest, figure.excess);
  }
  return largest;
}

TEST(InnovationTest, AlarmsAsSeldomAsStatedOfARightModel) {
  constexpr int kRuns = 2000;
  int alarms = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto white = Draw(100, static_cast<std::uint64_t>(run),
                            [](int, double x) { return x; });
    if (LargestExcess(TestInnovations(white, kAlarms)) > 1.0) ++alarms;
  }
  // Bonferroni's bound is the mean: Poisson of 20, exceeded once in 1000 by 34.
  EXPECT_LE(alarms, 34);
  EXPECT_GE(alarms, 3);
}

TEST(InnovationTest, FindsSizeLengthAndTimeOfAnErrorThatLasts) {
  constexpr int kCount = 512;
  const auto lasting = Draw(kCount, 5, [](int k, double x) {
    return x + (k >= 256 && k < 384 ? 2.0 : 0.0);
  });
  const auto figures = TestInnovations(lasting, kAlarms);
  ASSERT_EQ(figures.size(), 4u);
  const InnovationFigure& figure = figures.front();
  EXPECT_EQ(figure.sensor, 0);
  EXPECT_EQ(figure.component, 0);
  EXPECT_EQ(figure.length, 128u);
  EXPECT_NEAR(figure.duration, 128.0, 1e-9);
  EXPECT_NEAR(figure.t_begin, 256.0, 1e-9);
  EXPECT_NEAR(figure.t_end, 383.0, 1e-9);
  // One block of four has 2 sqrt(128) = 22.6 in sum, besides noise.
  const double tests = 4.0 * 10.0;
  const double quantile = ChiSquareQuantile(1.0 - kAlarms / tests, 4.0);
  EXPECT_NEAR(figure.excess, 22.6 / std::sqrt(quantile),
              3.0 / std::sqrt(quantile));
  for (std::size_t i = 1; i < figures.size(); ++i) {
    EXPECT_LT(figures[i].excess, 1.0);
  }
}

TEST(InnovationTest, AGapIsNoPartOfADuration) {
  auto lasting = Draw(512, 5, [](int k, double x) {
    return x + (k >= 256 && k < 384 ? 2.0 : 0.0);
  });
  for (NormalisedInnovation& one : lasting) {
    if (one.t > 400.0) one.t += 10000.0;
  }
  EXPECT_NEAR(TestInnovations(lasting, kAlarms).front().duration, 128.0, 1e-9);
}

TEST(InnovationTest, FindsSigmasThatAreTooSmallAtLengthOne) {
  const auto large = Draw(400, 7, [](int, double x) { return 3.0 * x; });
  const InnovationFigure figure = TestInnovations(large, kAlarms).front();
  EXPECT_NEAR(figure.rms, 3.0, 0.35);
  EXPECT_NEAR(figure.mean, 0.0, 0.6);
  EXPECT_GT(figure.excess, 2.0);
  EXPECT_NEAR(figure.beyond, 0.317, 0.1);
}

TEST(InnovationTest, LeavesRowsOfFewMeasurementsAlone) {
  const auto few = Draw(3, 9, [](int, double) { return 100.0; });
  EXPECT_TRUE(TestInnovations(few, kAlarms).empty());
}

}  // namespace
}  // namespace hindsight
