#include "receiver_errors/sequence_refinement.h"

#include <gtest/gtest.h>

#include <stdexcept>

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

/// From what lasts to the end; what the fixes behind the gap are taken for hangs on it.
TEST(RefineHypotheses, EndAnErrorWhereAGapHidesItsEnd) {
  TestProblem problem = PositionsOnly(90.0);
  AddError(20, 45, {8.0, -6.0, 3.0}, &problem);
  GateDecisions used(problem.measurements.size(), 1);
  for (std::size_t k = 40; k < 52; ++k) used[k] = 0;
  const LinearTape tape = TapeOf(problem, std::move(used));
  const std::size_t behind_gap = 40;
  EXPECT_EQ(FixesBehindGaps({tape, 0}), std::vector<std::size_t>{behind_gap});
  ModeSequence right = Good(tape);
  for (std::size_t i = 20; i < behind_gap; ++i) {
    right[i] = {ErrorMode::kBiased, i == 20};
  }
  ModeSequence lasting = right;
  for (std::size_t i = behind_gap; i < lasting.size(); ++i) {
    lasting[i] = {ErrorMode::kBiased, false, false, i % 2 == 0};
  }
  ErrorParameters p = WithoutOutliers();
  p.outlier_share = 0.02;
  const auto best = RefineHypotheses({tape, 0}, p, {{lasting}}).front();
  EXPECT_EQ(best.sequence, right);
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
