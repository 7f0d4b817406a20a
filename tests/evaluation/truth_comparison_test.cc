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

/// A stream of positions, and a solution that estimates its clock and arm.
struct Estimated {
  Dataset dataset;
  Solution solution;
};

Estimated ClockAndArm() {
  Estimated made;
  made.dataset.truth = TruthFromTable(Circle(1.0, 10.0));
  made.dataset.truth_lever_arm_b = {1.0, 2.0, 3.0};
  made.dataset.streams.resize(2);
  made.dataset.streams[1].sensor.time_offset = 0.25;
  made.solution.layout = NavigationLayout({});
  for (const BlockKind kind : {BlockKind::kTimeOffset, BlockKind::kLeverArm}) {
    Block block;
    block.key = {kind, 1};
    made.solution.layout.Add(block);
  }
  State state;
  state.parameters = Eigen::Vector4d(0.75, 4.0, 5.0, 6.0);
  made.solution.states.push_back(state);
  return made;
}

TEST(TruthOf, PositionsHaveTheClockAndTheArmThatAreEstimated) {
  Estimated made = ClockAndArm();
  made.dataset.truth_stream = 1;
  const SolutionTruth truth = TruthOf(made.dataset, made.solution);
  EXPECT_EQ(truth.lever_arm_b, Eigen::Vector3d(4.0, 5.0, 6.0));
  ASSERT_EQ(truth.points.size(), made.dataset.truth.size());
  EXPECT_EQ(truth.points[3].t, made.dataset.truth[3].t + 0.5);
  EXPECT_EQ(*truth.points[3].p_e, *made.dataset.truth[3].p_e);
}

TEST(TruthOf, AnythingElseStaysAsGiven) {
  Estimated made = ClockAndArm();
  for (const std::optional<std::size_t> stream :
       {std::optional<std::size_t>(), std::optional<std::size_t>(0)}) {
    made.dataset.truth_stream = stream;
    const SolutionTruth truth = TruthOf(made.dataset, made.solution);
    EXPECT_EQ(truth.lever_arm_b, made.dataset.truth_lever_arm_b);
    EXPECT_EQ(truth.points[3].t, made.dataset.truth[3].t);
  }
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
