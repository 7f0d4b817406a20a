#include "filters/tape_adjoint.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "filters/dense_least_squares.h"
#include "filters/forward_filter.h"
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

}  // namespace
}  // namespace hindsight
