#include "receiver_errors/error_history.h"

#include <gtest/gtest.h>

#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "receiver_errors/history_refinement.h"
#include "receiver_errors/history_smoother.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem PositionsOnly(double duration) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = duration;
  options.position_sigma = 0.5;
  options.velocity_sigma = 0.0;
  return MakeProblem(options, 3);
}

LinearTape TapeOf(const TestProblem& problem) {
  Problem posed = problem.Pose(GateDecisions(problem.measurements.size(), 1));
  return RunLinearizedFilter(problem.truth, &posed);
}

ErrorHistory Good(const LinearTape& tape) {
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) fixes += HasFix(tape, k, 0);
  return ErrorHistory(fixes);
}

ErrorParameters WithoutOutliers() {
  ErrorParameters p;
  p.outlier_share = 1e-12;
  p.sigma = 10.0;
  p.tau = 1e8;
  p.slight_tau = 1e8;
  return p;
}

TEST(ErrorHistory, ThatIsGoodIsTheKalmanFilterAndItsSmoother) {
  const LinearTape tape = TapeOf(PositionsOnly(30.0));
  const ErrorHistory good = Good(tape);
  double log_likelihood = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      log_likelihood += z.log_likelihood;
    }
  }
  const HistoryScore score = ScoreHistory(tape, 0, WithoutOutliers(), good);
  EXPECT_NEAR(score.log_likelihood, log_likelihood,
              1e-6 * std::abs(log_likelihood));
  const std::vector<ErrorVector> smoothed =
      SmoothHistory(tape, 0, WithoutOutliers(), good);
  LinearTape copy = TapeOf(PositionsOnly(30.0));
  const SmoothedTrajectory rts = SmoothRts(std::move(copy));
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const ErrorVector sigma = rts.P.Get(k).diagonal().cwiseSqrt();
    const ErrorVector difference = smoothed[k].head(tape.dim()) - rts.d[k];
    EXPECT_LT((difference.array() / sigma.array()).abs().maxCoeff(), 1e-5) << k;
    EXPECT_TRUE(smoothed[k].tail(6).isZero(0.0));
  }
}

TEST(ErrorHistory, FindsWhenABiasBeginsAndEnds) {
  TestProblem problem = PositionsOnly(60.0);
  for (std::size_t k = 20; k < 30; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(8.0, -8.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<ScoredHistory> found = RefineHistories(
      tape, 0, WithoutOutliers(), SearchHistories(tape, 0, WithoutOutliers()));
  ErrorHistory expected = Good(tape);
  for (std::size_t i = 20; i < 30; ++i) {
    expected[i] = {ErrorMode::kBiased, i == 20};
  }
  EXPECT_EQ(found.front().history, expected);
  // Without the bias the history is next to impossible.
  const HistoryScore good =
      ScoreHistory(tape, 0, WithoutOutliers(), Good(tape));
  EXPECT_LT(good.log_likelihood + good.log_prior,
            found.front().log_posterior - 100.0);
}

TEST(ErrorHistory, RemembersADriftThatNoSingleFixShows) {
  TestProblem problem = PositionsOnly(60.0);
  constexpr double kRate = 0.4;  // less than a sigma from fix to fix
  for (std::size_t k = 20; k < 45; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e +=
        NedAxes(fix.p_e) *
        Eigen::Vector3d(kRate * (static_cast<double>(k) - 20.0), 0.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<ScoredHistory> found =
      SearchHistories(tape, 0, WithoutOutliers());
  EXPECT_EQ(found.front().history[35].mode, ErrorMode::kDrifting);
  const ErrorHistory best = ClimbHistories(tape, 0, WithoutOutliers(), found);
  EXPECT_EQ(best[10].mode, ErrorMode::kGood);
  EXPECT_EQ(best[35].mode, ErrorMode::kDrifting);
  EXPECT_EQ(best[50].mode, ErrorMode::kGood);
}

}  // namespace
}  // namespace hindsight
