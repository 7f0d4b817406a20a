#include "receiver_errors/sequence_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "receiver_errors/receiver_tape.h"

namespace hindsight {
namespace {

using testing::AddError;
using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

/// Climbs go from all good to an error of 20 s.
class Refinement : public ::testing::Test {
 protected:
  static LinearTape Tape() {
    TestProblem problem = PositionsOnly(60.0);
    AddError(20, 40, {8.0, -6.0, 3.0}, &problem);
    return TapeOf(problem);
  }
  static ErrorParameters Parameters() {
    ErrorParameters p = WithoutOutliers();
    p.outlier_share = 0.02;
    return p;
  }
  void TearDown() override { SetThreadCount(before_); }

  LinearTape tape_ = Tape();
  SensorTape seen_{tape_, 0};
  std::vector<Hypothesis> start_ = {{Good(tape_)}};

 private:
  int before_ = ThreadCount();
};

/// Also where it ends within those that several threads score at once.
TEST_F(Refinement, EndsAsItDoesWithOneThreadWhereverTheEffortDoes) {
  std::vector<ModeSequence> ends;
  for (const double most : {200.0, 700.0, 1500.0, 4000.0, 9000.0, 1e6}) {
    SetThreadCount(1);
    SearchEffort one(most, nullptr);
    const ModeSequence by_one =
        ClimbSequences(seen_, Parameters(), start_, &one);
    SetThreadCount(3);
    SearchEffort three(most, nullptr);
    EXPECT_EQ(ClimbSequences(seen_, Parameters(), start_, &three), by_one);
    EXPECT_EQ(three.spent(), one.spent());
    if (ends.empty() || ends.back() != by_one) ends.push_back(by_one);
  }
  EXPECT_GT(ends.size(), 2u);
}

/// Behind a gap over which the IMU leaves open more than the error, nothing tells whether
/// it lasts: a climb has no reason to leave what it begins from.
TEST(RefineHypotheses, EndAnErrorWhereAGapHidesItsEnd) {
  TestProblem problem = PositionsOnly(160.0);
  AddError(20, 60, {2.0, -1.5, 0.5}, &problem);
  GateDecisions used(problem.measurements.size(), 1);
  for (std::size_t k = 40; k < 100; ++k) used[k] = 0;
  const LinearTape tape = TapeOf(problem, std::move(used));
  const std::size_t behind_gap = 40;
  EXPECT_EQ(FixesBehindGaps({tape, 0}), std::vector<std::size_t>{behind_gap});
  ModeSequence lasting = Good(tape);
  for (std::size_t i = 20; i < lasting.size(); ++i) {
    lasting[i] = {ErrorMode::kBiased, i == 20};
  }
  ModeSequence right = lasting;
  std::fill(right.begin() + behind_gap, right.end(), ErrorStep{});
  ErrorParameters p = WithoutOutliers();
  p.sigma = 2.0;
  for (const ModeSequence& from : {lasting, right}) {
    std::vector<ModeSequence> found;
    for (const Hypothesis& one : RefineHypotheses({tape, 0}, p, {{from}})) {
      found.push_back(one.sequence);
    }
    EXPECT_EQ(std::ranges::count(found, lasting), 1);
    EXPECT_EQ(std::ranges::count(found, right), 1);
  }
}

/// Of a drift that is metres farther at its first fix if it began at the fix before.
TEST(ClimbSequences, TellWhenBetweenTwoFixesADriftBegan) {
  constexpr std::size_t kFirst = 30;
  constexpr std::size_t kEnd = 50;
  const Eigen::Vector3d rate(12.0, -9.0, 0.0);
  for (const auto& [share, onset] : {std::pair{0.875, Onset::kFirst},
                                     {0.625, Onset::kSecond},
                                     {0.375, Onset::kThird},
                                     {0.125, Onset::kFourth}}) {
    TestProblem problem = PositionsOnly(80.0);
    for (std::size_t k = kFirst; k < kEnd; ++k) {
      const double T = problem.truth[kFirst].t - problem.truth[kFirst - 1].t;
      const double u = problem.truth[k].t - problem.truth[kFirst].t + share * T;
      AddError(k, k + 1, u * rate, &problem);
    }
    const LinearTape tape = TapeOf(problem);
    ErrorParameters p = WithoutOutliers();
    p.rate_sigma = 10.0;
    ModeSequence start = Good(tape);
    for (std::size_t i = kFirst; i < kEnd; ++i) {
      start[i] = {ErrorMode::kDrifting, i == kFirst};
    }
    ModeSequence right = start;
    right[kFirst].onset = onset;
    EXPECT_EQ(ClimbSequences({tape, 0}, p, {{start}}), right) << share;
  }
}

TEST_F(Refinement, IsAbandonedWhereWhoeverIsAskedThrows) {
  for (const int threads : {1, 3}) {
    SetThreadCount(threads);
    SearchEffort effort(4000.0, [](double fraction) {
      if (fraction > 0.3) throw std::runtime_error("enough");
      return true;
    });
    EXPECT_THROW(ClimbSequences(seen_, Parameters(), start_, &effort),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace hindsight
