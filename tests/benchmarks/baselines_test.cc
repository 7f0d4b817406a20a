#include "benchmarks/baselines.h"

#include <gtest/gtest.h>

#include "filters/iterated_smoother.h"
#include "problems/batch.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::ScaledDifference;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// A minute of fixes of a centimetre or two.
TestProblem Minute(double spacing) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.duration = 60.0;
  options.spacing = spacing;
  options.errors = true;
  return MakeProblem(options, 5);
}

/// Largest component of the difference, in sigmas.
double LargestInSigmas(const ErrorLayout& layout,
                       const std::vector<State>& states,
                       const BatchResult& batch) {
  double largest = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const ErrorVector d = Local(layout, batch.states[k], states[k]);
    const Eigen::VectorXd sigma = batch.P.Get(k).diagonal().cwiseSqrt();
    largest = std::max(largest, d.cwiseQuotient(sigma).cwiseAbs().maxCoeff());
  }
  return largest;
}

double LargestCovarianceDifference(const CovarianceSeries& P,
                                   const CovarianceSeries& expected) {
  double largest = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    largest = std::max(largest, ScaledDifference(P.Get(k), expected.Get(k)));
  }
  return largest;
}

TEST(Baselines, SolveTheSameProblem) {
  for (const double spacing : {1.0, 0.1}) {
    const TestProblem problem = Minute(spacing);
    Problem posed = problem.Pose(GateDecisions(problem.measurements.size(), 1));
    const LinearTape tape = RunExtendedKalmanFilter(&posed);
    std::vector<State> filtered;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      filtered.push_back(tape.epoch(k).x_plus);
    }
    const SmoothedTrajectory smoothed = SmoothRts(tape);
    const BatchResult batch = SolveBatch(smoothed.states, {}, &posed);
    ASSERT_TRUE(batch.converged);
    const BaselineResult ceres = SolveByCeres(filtered, true, &posed);
    const BaselineResult bare = SolveBlockTridiagonal(filtered, &posed);
    // Ceres does not take a last step whose gain the rounding of the cost hides.
    EXPECT_LT(LargestInSigmas(problem.layout, ceres.states, batch), 1e-4);
    EXPECT_LT(LargestInSigmas(problem.layout, bare.states, batch), 1e-6);
    for (const BaselineResult* result : {&ceres, &bare}) {
      SCOPED_TRACE((result == &ceres ? "Ceres, " : "blocks, ") +
                   std::to_string(spacing) + " s");
      EXPECT_LT(LargestCovarianceDifference(result->P, batch.P), 1e-6);
    }
    // They were not there from the start.
    EXPECT_GT(LargestInSigmas(problem.layout, filtered, batch), 0.1);
  }
}

}  // namespace
}  // namespace hindsight
