#include "filters/rts.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "base/parallel.h"
#include "filters/dense_least_squares.h"
#include "filters/forward_filter.h"
#include "filters/transport.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::DenseSolution;
using testing::MakeProblem;
using testing::RichLayout;
using testing::ScaledDifference;
using testing::SolveDense;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// Every block walks, so that the dense problem has a full rank noise.
ErrorLayout WalkingRichLayout(const ImuNoise& noise) {
  const ErrorLayout rich = RichLayout(noise);
  ErrorLayout layout;
  for (Block block : rich.blocks()) {
    if (block.evolution.is_constant()) {
      block.evolution = Evolution::RandomWalk(0.01 * block.sigma0.x());
    }
    layout.Add(block);
  }
  return layout;
}

TestProblem RichProblem(bool rich) {
  TestProblemOptions options;
  // Walks strong enough to keep the dense normal equations well conditioned.
  options.noise = TacticalNoise(true);
  options.noise.gyro_bias_walk = 1e-5;
  options.noise.accel_bias_walk = 1e-3;
  options.layout =
      rich ? WalkingRichLayout(options.noise) : TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 10.0;
  return MakeProblem(options, 5);
}

LinearTape FixedNominalTape(const TestProblem& problem, Problem* posed) {
  // A nominal that is off: defects c do not vanish.
  std::vector<State> nominal = problem.truth;
  Random random(9);
  for (State& x : nominal) {
    x = Retract(
        problem.layout, x,
        0.1 * testing::Draw(problem.layout.InitialCovariance(), &random));
  }
  return RunLinearizedFilter(nominal, posed);
}

TEST(Rts, EqualsDenseLeastSquaresOnTheTape) {
  for (const bool rich : {false, true}) {
    const TestProblem problem = RichProblem(rich);
    Problem posed = problem.Pose();
    const LinearTape tape = FixedNominalTape(problem, &posed);
    double largest_defect = 0.0;
    for (std::size_t k = 1; k < tape.size(); ++k) {
      largest_defect = std::max(largest_defect, tape.epoch(k).c.norm());
    }
    EXPECT_GT(largest_defect, 0.01);
    const SmoothedTrajectory smoothed = SmoothRts(tape);
    const DenseSolution dense = SolveDense(tape);
    const int n = tape.dim();
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const Eigen::MatrixXd P = dense.CovarianceAt(k, n);
      // Scaled normal equations of condition 1e9 to 1e10 leave 6 digits.
      EXPECT_LT(ScaledDifference(smoothed.P.Get(k), P), 1e-6) << k;
      const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((smoothed.d[k] - dense.At(k, n))
                    .cwiseProduct(scale)
                    .cwiseAbs()
                    .maxCoeff(),
                1e-5)
          << k;
    }
  }
}

TEST(Rts, LastEpochIsTheFilters) {
  const TestProblem problem = RichProblem(false);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory smoothed = SmoothRts(tape);
  EXPECT_EQ(smoothed.states.back().p_e, tape.back().x_plus.p_e);
  EXPECT_EQ(smoothed.P.Get(tape.size() - 1), tape.P_plus(tape.size() - 1));
}

TEST(Rts, SmoothedIsNeverWorseThanFiltered) {
  const TestProblem problem = RichProblem(true);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory smoothed = SmoothRts(tape);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const ErrorMatrix P = tape.P_plus(k);
    const Eigen::VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        s.asDiagonal() * (P - smoothed.P.Get(k)) * s.asDiagonal());
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9) << k;
  }
}

TEST(Rts, ConsumingTheTapeGivesTheSameBits) {
  const TestProblem problem = RichProblem(true);
  Problem posed = problem.Pose();
  LinearTape tape = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory kept = SmoothRts(tape);
  LinearTape again = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory consumed = SmoothRts(std::move(tape));
  const SmoothedTrajectory bare =
      SmoothRts(std::move(again), {.errors = false});
  EXPECT_TRUE(bare.d.empty());
  ASSERT_EQ(bare.states.size(), kept.states.size());
  ASSERT_EQ(consumed.states.size(), kept.states.size());
  for (std::size_t k = 0; k < kept.states.size(); ++k) {
    EXPECT_EQ(consumed.states[k].p_e, kept.states[k].p_e);
    EXPECT_EQ(consumed.states[k].q_eb.coeffs(), kept.states[k].q_eb.coeffs());
    EXPECT_EQ(consumed.d[k], kept.d[k]);
    EXPECT_EQ(consumed.P.Get(k), kept.P.Get(k));
    EXPECT_EQ(bare.states[k].p_e, kept.states[k].p_e);
    EXPECT_EQ(bare.P.Get(k), kept.P.Get(k));
  }
}

TEST(Rts, CovariancesMayBeInTheTangentAtTheSmoothedStates) {
  const TestProblem problem = RichProblem(true);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory at_nominal = SmoothRts(tape);
  const SmoothedTrajectory at_smoothed =
      SmoothRts(tape, {.covariances = RtsOptions::Tangent::kSmoothed});
  bool differ = false;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    ErrorMatrix P = at_nominal.P.Get(k);
    MoveCovariance(
        Transport(problem.layout, tape.epoch(k).x_plus, at_nominal.states[k]),
        &P);
    EXPECT_EQ(at_smoothed.P.Get(k), P) << k;
    differ = differ || P != at_nominal.P.Get(k);
  }
  EXPECT_TRUE(differ);
}

/// Steps are prepared, and what came of them is written, beside those that are gone.
TEST(Rts, GivesTheSameBitsWithAnyNumberOfThreads) {
  constexpr std::size_t kSeveralTimesAhead = 200;
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 210.0;
  const TestProblem problem = MakeProblem(options, 5);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  ASSERT_GT(tape.size(), kSeveralTimesAhead);
  const int threads = ThreadCount();
  std::vector<SmoothedTrajectory> all;
  for (const int count : {1, 2, 3}) {
    SetThreadCount(count);
    all.push_back(SmoothRts(tape));
  }
  SetThreadCount(threads);
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t k = 0; k < tape.size(); ++k) {
      EXPECT_EQ(all[i].states[k].p_e, all[0].states[k].p_e) << k;
      EXPECT_EQ(all[i].d[k], all[0].d[k]) << k;
      EXPECT_EQ(all[i].P.Get(k), all[0].P.Get(k)) << k;
    }
  }
}

TEST(Rts, MeansAloneAreThoseWithCovariances) {
  const TestProblem problem = RichProblem(true);
  Problem posed = problem.Pose();
  for (const bool reset : {false, true}) {
    const LinearTape tape = reset ? RunExtendedKalmanFilter(&posed)
                                  : FixedNominalTape(problem, &posed);
    const SmoothedTrajectory smoothed = SmoothRts(tape);
    const SmoothedTrajectory means = SmoothMeans(tape);
    EXPECT_TRUE(means.P.empty());
    ASSERT_EQ(means.states.size(), smoothed.states.size());
    for (std::size_t k = 0; k < smoothed.states.size(); ++k) {
      EXPECT_EQ(means.d[k], smoothed.d[k]);
      EXPECT_EQ(means.states[k].p_e, smoothed.states[k].p_e);
      EXPECT_EQ(means.states[k].q_eb.coeffs(),
                smoothed.states[k].q_eb.coeffs());
    }
  }
}

TEST(LinearTape, PopBackLeavesTheRestAndTakesNewEpochs) {
  const TestProblem problem = RichProblem(true);
  Problem posed = problem.Pose();
  const LinearTape whole = RunExtendedKalmanFilter(&posed);
  LinearTape tape = RunExtendedKalmanFilter(&posed);
  const std::size_t size = tape.size();
  const TapeEpoch last = tape.back();
  const Transition transition{tape.Phi(size - 1), tape.Q(size - 1), last.c};
  const ErrorMatrix P_minus = tape.P_minus(size - 1);
  const ErrorMatrix P_plus = tape.P_plus(size - 1);
  tape.PopBack();
  tape.PopBack();
  ASSERT_EQ(tape.size(), size - 2);
  // What follows overwrites the memory given back, nothing else.
  tape.Append(last, transition, P_minus, P_plus);
  EXPECT_EQ(tape.measurements(size - 2).size(), 0u);
  EXPECT_EQ(tape.P_plus(size - 2), P_plus);
  for (std::size_t k = 0; k < size - 2; ++k) {
    EXPECT_EQ(tape.P_minus(k), whole.P_minus(k)) << k;
    EXPECT_EQ(tape.P_plus(k), whole.P_plus(k)) << k;
    ASSERT_EQ(tape.measurements(k).size(), whole.measurements(k).size());
    for (std::size_t i = 0; i < tape.measurements(k).size(); ++i) {
      EXPECT_EQ(tape.measurements(k)[i].H, whole.measurements(k)[i].H);
      EXPECT_EQ(tape.measurements(k)[i].S, whole.measurements(k)[i].S);
    }
  }
}

}  // namespace
}  // namespace hindsight
