#include "filters/tape_adjoint.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "filters/dense_least_squares.h"
#include "filters/forward_filter.h"
#include "filters/iterated_smoother.h"
#include "filters/rts.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::ScaledDifference;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem WalkingDrive() {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  return MakeProblem(options, 11);
}

TEST(TapeAdjoint, LeadsToTheCovariancesOfTheSmoother) {
  const TestProblem problem = WalkingDrive();
  Problem posed = problem.Pose();
  const LinearTape tape = RunLinearizedFilter(problem.truth, &posed);
  const SmoothedTrajectory smoothed = SmoothRts(tape);
  std::size_t next = tape.size();
  ForEachLambda(tape, [&](std::size_t k, const ErrorMatrix& Lambda) {
    EXPECT_EQ(k, --next);
    const ErrorMatrix P_minus = tape.P_minus(k);
    const ErrorMatrix P = P_minus - P_minus * Lambda * P_minus;
    EXPECT_LT(ScaledDifference(P, smoothed.P.Get(k)), 1e-6) << k;
  });
  EXPECT_EQ(next, 0u);
}

TEST(TapeAdjoint, NeedsATapeAboutAFixedNominal) {
  const TestProblem problem = WalkingDrive();
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  EXPECT_THROW(ForEachLambda(tape, [](std::size_t, const ErrorMatrix&) {}),
               std::logic_error);
}

TEST(IteratedSmoother, FindsTheSameWithoutCovariances) {
  const TestProblem problem = WalkingDrive();
  IterationOptions options;
  options.max_iterations = 3;
  Problem with = problem.Pose();
  const IteratedResult a = SmoothIterated(problem.truth, options, &with);
  options.covariances = false;
  Problem without = problem.Pose();
  const IteratedResult b = SmoothIterated(problem.truth, options, &without);
  EXPECT_EQ(a.log_likelihood, b.log_likelihood);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_FALSE(a.trajectory.P.empty());
  EXPECT_TRUE(b.trajectory.P.empty());
  for (std::size_t k = 0; k < a.trajectory.states.size(); ++k) {
    EXPECT_EQ(a.trajectory.states[k].p_e, b.trajectory.states[k].p_e) << k;
  }
}

}  // namespace
}  // namespace hindsight
