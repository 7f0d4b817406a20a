#include "evaluation/truth_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

/// A circle of 50 m at 10 m/s, rows at multiples of `dt`, displaced to the
/// north by `offset` [m].
SolutionTable Circle(double dt, double end, double offset = 0.0) {
  const Eigen::Vector3d origin = EcefFromGeodetic({0.7, 0.2, 100.0});
  const Eigen::Matrix3d C_en = NedAxes(origin);
  SolutionTable table;
  for (int k = 0; k * dt <= end + 1e-9; ++k) {
    const double angle = 0.2 * k * dt;
    table.t.push_back(k * dt);
    table.p_e.emplace_back(
        origin + C_en * Eigen::Vector3d(50.0 * std::cos(angle) + offset,
                                        50.0 * std::sin(angle), 0.0));
    table.v_e.emplace_back(C_en * Eigen::Vector3d(-10.0 * std::sin(angle),
                                                  10.0 * std::cos(angle), 0.0));
  }
  return table;
}

TEST(ThinTruth, KeepsTenPointsASecond) {
  TruthSeries truth = TruthFromTable(Circle(0.01, 10.0));
  ThinTruth(&truth);
  ASSERT_EQ(truth.size(), 101u);
  EXPECT_NEAR(truth[1].t, 0.1, 1e-9);
  const std::size_t before = truth.size();
  ThinTruth(&truth);
  EXPECT_EQ(truth.size(), before);
}

TEST(ThinTruth, KeepsFewEnoughOfADay) {
  TruthSeries truth;
  for (int k = 0; k < 864000; ++k) {
    TruthPoint point;
    point.t = 0.1 * k;
    truth.push_back(point);
  }
  ThinTruth(&truth);
  EXPECT_LE(truth.size(), 50000u);
  EXPECT_GT(truth.size(), 40000u);
  EXPECT_GT(truth.back().t, 86390.0);
  const std::size_t before = truth.size();
  ThinTruth(&truth);
  EXPECT_EQ(truth.size(), before);
}

TEST(CompareWithTruth, TakesRowsAtTheTruthAsTheyAre) {
  // Rows at the truth's times, too far apart to be interpolated.
  const SolutionTable solution = Circle(5.0, 20.0, 1.0);
  const TruthSeries truth = TruthFromTable(Circle(5.0, 20.0));
  const TrajectoryStatistics s =
      CompareWithTruth(solution, truth, {}).statistics;
  EXPECT_FALSE(s.at_solution_rows);
  EXPECT_EQ(s.truth_count, 5u);
  EXPECT_EQ(s.matched_count, 5u);
  EXPECT_NEAR(s.position->horizontal.max, 1.0, 1e-6);
}

TEST(CompareWithTruth, ComparesASparseSolutionAtItsOwnRows) {
  const SolutionTable solution = Circle(1.0, 20.0, 1.0);
  const TruthSeries truth = TruthFromTable(Circle(0.03, 20.0));
  const TrajectoryStatistics s =
      CompareWithTruth(solution, truth, {}).statistics;
  EXPECT_TRUE(s.at_solution_rows);
  EXPECT_EQ(s.truth_count, 21u);
  // The last row lies beyond the truth's last point at 19.98 s.
  EXPECT_EQ(s.matched_count, 20u);
  EXPECT_NEAR(s.position->horizontal.max, 1.0, 1e-5);
}

TEST(CompareWithTruth, InterpolatesADenseSolution) {
  const SolutionTable solution = Circle(0.03, 20.0, 1.0);
  const TruthSeries truth = TruthFromTable(Circle(1.0, 20.0));
  const TrajectoryStatistics s =
      CompareWithTruth(solution, truth, {}).statistics;
  EXPECT_FALSE(s.at_solution_rows);
  EXPECT_EQ(s.truth_count, 21u);
  EXPECT_EQ(s.matched_count, 20u);
  EXPECT_NEAR(s.position->horizontal.max, 1.0, 1e-5);
}

}  // namespace
}  // namespace hindsight
