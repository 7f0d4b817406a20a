#include "receiver_errors/mode_sequence.h"

#include <gtest/gtest.h>

#include "filters/rts.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_refinement.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

TEST(ModeSequence, ThatIsGoodIsTheKalmanFilterAndItsSmoother) {
  const LinearTape tape = TapeOf(PositionsOnly(30.0));
  const ModeSequence good = Good(tape);
  double log_likelihood = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      log_likelihood += z.log_likelihood;
    }
  }
  const SequenceScore score = ScoreSequence(tape, 0, WithoutOutliers(), good);
  EXPECT_NEAR(score.log_likelihood, log_likelihood,
              1e-6 * std::abs(log_likelihood));
  const std::vector<ErrorVector> smoothed =
      SmoothSequence(tape, 0, WithoutOutliers(), good);
  LinearTape copy = TapeOf(PositionsOnly(30.0));
  const SmoothedTrajectory rts = SmoothRts(std::move(copy));
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const ErrorVector sigma = rts.P.Get(k).diagonal().cwiseSqrt();
    const ErrorVector difference = smoothed[k].head(tape.dim()) - rts.d[k];
    EXPECT_LT((difference.array() / sigma.array()).abs().maxCoeff(), 1e-5) << k;
    EXPECT_TRUE(smoothed[k].tail(6).isZero(0.0));
  }
}

TEST(ModeSequence, FindsWhenABiasBeginsAndEnds) {
  TestProblem problem = PositionsOnly(60.0);
  for (std::size_t k = 20; k < 30; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(8.0, -8.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<Hypothesis> found = RefineHypotheses(
      tape, 0, WithoutOutliers(), SearchHypotheses(tape, 0, WithoutOutliers()));
  ModeSequence expected = Good(tape);
  for (std::size_t i = 20; i < 30; ++i) {
    expected[i] = {ErrorMode::kBiased, i == 20};
  }
  EXPECT_EQ(found.front().sequence, expected);
  // Without the bias the sequence is next to impossible.
  const SequenceScore good =
      ScoreSequence(tape, 0, WithoutOutliers(), Good(tape));
  EXPECT_LT(good.log_likelihood + good.log_prior,
            found.front().log_posterior - 100.0);
}

TEST(ModeSequence, RemembersADriftThatNoSingleFixShows) {
  TestProblem problem = PositionsOnly(90.0);
  constexpr double kRate = 0.4;  // less than a sigma from fix to fix
  for (std::size_t k = 20; k < 60; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e +=
        NedAxes(fix.p_e) *
        Eigen::Vector3d(kRate * (static_cast<double>(k) - 20.0), 0.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<Hypothesis> found =
      SearchHypotheses(tape, 0, WithoutOutliers());
  EXPECT_EQ(found.front().sequence[40].mode, ErrorMode::kDrifting);
  const ModeSequence best = ClimbSequences(tape, 0, WithoutOutliers(), found);
  EXPECT_EQ(best[10].mode, ErrorMode::kGood);
  EXPECT_EQ(best[40].mode, ErrorMode::kDrifting);
  EXPECT_EQ(best[70].mode, ErrorMode::kGood);
}

}  // namespace
}  // namespace hindsight
