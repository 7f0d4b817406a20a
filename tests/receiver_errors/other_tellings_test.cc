#include "receiver_errors/other_tellings.h"

#include <gtest/gtest.h>

#include "receiver_errors/receiver_tape.h"

namespace hindsight {
namespace {

using testing::AddError;
using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;

/// Fixes from 20 to 39 s and one of 40 s between two gaps.
class BetweenGaps : public ::testing::Test {
 protected:
  static constexpr std::size_t kBegin = 20;
  static constexpr std::size_t kLone = 40;

  /// What BestOutlierThatIsRight finds where fixes `first` to past the last are off.
  Attempt Find(std::size_t first, std::size_t past) {
    TestProblem problem = PositionsOnly(80.0);
    AddError(first, past, {0.0, 6.0, 0.0}, &problem);
    GateDecisions used(problem.measurements.size(), 1);
    for (std::size_t k = 8; k < kBegin; ++k) used[k] = 0;
    for (std::size_t k = kLone + 1; k < 53; ++k) used[k] = 0;
    const LinearTape tape = TapeOf(problem, used);
    SearchEffort effort(1e9, nullptr);
    const SensorTape seen(tape, 0);
    const RegimeProblem of{seen, 0.5, false, &effort};
    return BestOutlierThatIsRight(of, {Good(tape)});
  }
};

/// Twenty that err alike before it make an outlier of the one that is right.
TEST_F(BetweenGaps, AnOutlierMayBeTheOneThatIsRight) {
  const Attempt found = Find(kBegin, kLone);
  constexpr std::size_t kFirst = 8;  // those before the gap
  constexpr std::size_t kRight = kFirst + kLone - kBegin;
  ASSERT_GT(found.sequence.size(), kRight + 1);
  for (std::size_t i = 0; i < found.sequence.size(); ++i) {
    EXPECT_EQ(found.sequence[i].mode,
              i >= kFirst && i < kRight ? ErrorMode::kBiased : ErrorMode::kGood)
        << i;
    EXPECT_EQ(found.sequence[i].anew, i == kFirst) << i;
  }
}

/// No gap hides where the others begin or end to err.
TEST(OtherTellings, AnOutlierAtAnEndOfARecordingWithoutGapsIsOne) {
  TestProblem problem = PositionsOnly(80.0);
  AddError(problem.measurements.size() - 1, problem.measurements.size(),
           {0.0, 6.0, 0.0}, &problem);
  const LinearTape tape = TapeOf(problem);
  SearchEffort effort(1e9, nullptr);
  const SensorTape seen(tape, 0);
  const RegimeProblem of{seen, 0.5, false, &effort};
  EXPECT_TRUE(BestOutlierThatIsRight(of, {Good(tape)}).sequence.empty());
}

TEST_F(BetweenGaps, FixesThatAgreeAreNone) {
  EXPECT_TRUE(Find(kBegin, kBegin).sequence.empty());
}

}  // namespace
}  // namespace hindsight
