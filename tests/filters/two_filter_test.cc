#include "filters/two_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "filters/dense_least_squares.h"
#include "filters/forward_filter.h"
#include "support/seed_count.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::DenseSolution;
using testing::LargestError;
using testing::MakeProblem;
using testing::RichLayout;
using testing::ScaledDifference;
using testing::SolveDense;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem NoisyProblem(bool rich, bool walk) {
  TestProblemOptions options;
  options.noise = TacticalNoise(walk);
  options.layout =
      rich ? RichLayout(options.noise) : TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 30.0;
  return MakeProblem(options, 5);
}

/// A nominal that is off, so that means and defects do not vanish.
LinearTape FixedTape(const TestProblem& problem, Problem* posed) {
  std::vector<State> nominal = problem.truth;
  Random random(9);
  for (State& x : nominal) {
    x = Retract(
        problem.layout, x,
        0.1 * testing::Draw(problem.layout.InitialCovariance(), &random));
  }
  return RunLinearizedFilter(nominal, posed);
}

void ExpectSame(const ErrorLayout& layout, const SmoothedTrajectory& a,
                const SmoothedTrajectory& b, double metres, double radians) {
  EXPECT_LT(LargestError(layout, a.states, b.states, BlockKind::kPosition),
            metres);
  EXPECT_LT(LargestError(layout, a.states, b.states, BlockKind::kAttitude),
            radians);
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    EXPECT_LT(ScaledDifference(a.P.Get(k), b.P.Get(k)), 1e-6) << k;
    EXPECT_LT((a.d[k] - b.d[k]).head<3>().norm(), metres) << k;
  }
}

TEST(TwoFilter, EqualsRtsWhereTheNominalIsReset) {
  for (const bool rich : {false, true}) {
    for (const bool walk : {false, true}) {
      const TestProblem problem = NoisyProblem(rich, walk);
      Problem posed = problem.Pose();
      const LinearTape tape = RunExtendedKalmanFilter(&posed);
      ExpectSame(problem.layout, SmoothTwoFilter(tape).trajectory,
                 SmoothRts(tape), 1e-6, 1e-9);
    }
  }
}

TEST(TwoFilter, EqualsRtsAboutAFixedNominal) {
  for (const bool rich : {false, true}) {
    const TestProblem problem = NoisyProblem(rich, true);
    Problem posed = problem.Pose();
    const LinearTape tape = FixedTape(problem, &posed);
    ExpectSame(problem.layout, SmoothTwoFilter(tape).trajectory,
               SmoothRts(tape), 1e-6, 1e-9);
  }
}

TEST(TwoFilter, EqualsDenseLeastSquares) {
  TestProblemOptions options;
  // Walks strong enough to keep the dense normal equations well conditioned.
  options.noise = TacticalNoise(true);
  options.noise.gyro_bias_walk = 1e-5;
  options.noise.accel_bias_walk = 1e-3;
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 10.0;
  const TestProblem problem = MakeProblem(options, 5);
  Problem posed = problem.Pose();
  const LinearTape tape = FixedTape(problem, &posed);
  const SmoothedTrajectory smoothed = SmoothTwoFilter(tape).trajectory;
  const DenseSolution dense = SolveDense(tape);
  const int n = tape.dim();
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const Eigen::MatrixXd P = dense.CovarianceAt(k, n);
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

TEST(TwoFilter, RejectedMeasurementsTakeNoPart) {
  const TestProblem problem = NoisyProblem(false, true);
  GateDecisions decisions(problem.measurements.size(), 1);
  for (std::size_t i = 0; i < decisions.size(); i += 3) decisions[i] = 0;
  Problem posed = problem.Pose(decisions);
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  ExpectSame(problem.layout, SmoothTwoFilter(tape).trajectory, SmoothRts(tape),
             1e-6, 1e-9);
}

TEST(TwoFilter, LastEpochIsTheFilters) {
  const TestProblem problem = NoisyProblem(true, true);
  Problem posed = problem.Pose();
  for (const LinearTape& tape :
       {RunExtendedKalmanFilter(&posed), FixedTape(problem, &posed)}) {
    const State filtered =
        tape.back().reset
            ? tape.back().x_plus
            : Retract(problem.layout, tape.back().x_plus, tape.back().dx_plus);
    const SmoothedTrajectory smoothed = SmoothTwoFilter(tape).trajectory;
    EXPECT_LT((smoothed.states.back().p_e - filtered.p_e).norm(), 1e-8);
    EXPECT_LT(ScaledDifference(smoothed.P.Get(tape.size() - 1),
                               tape.P_plus(tape.size() - 1)),
              1e-12);
  }
}

TEST(TwoFilter, SmoothedIsNeverWorseThanFiltered) {
  const TestProblem problem = NoisyProblem(true, true);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const SmoothedTrajectory smoothed = SmoothTwoFilter(tape).trajectory;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const ErrorMatrix P = tape.P_plus(k);
    const Eigen::VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        s.asDiagonal() * (P - smoothed.P.Get(k)) * s.asDiagonal());
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12) << k;
  }
}

TEST(TwoFilter, FullStateInTheAdditiveChartEqualsTheErrorForm) {
  for (const bool rich : {false, true}) {
    const TestProblem problem = NoisyProblem(rich, true);
    Problem posed = problem.Pose();
    for (const LinearTape& tape :
         {RunExtendedKalmanFilter(&posed), FixedTape(problem, &posed)}) {
      const TwoFilterResult full =
          SmoothTwoFilterConventional(tape, ChartKind::kAdditive);
      const TwoFilterResult error = SmoothTwoFilter(tape);
      // Rotations compose to second order in the smoother's correction, below
      // 1e-3 rad here.
      ExpectSame(problem.layout, full.trajectory, error.trajectory, 1e-4, 1e-6);
      for (std::size_t k = 0; k + 5 < tape.size(); ++k) {
        EXPECT_NEAR(full.part.separation[k], error.part.separation[k], 1e-4)
            << k;
        const FilterSeparation& a = full.part.components[k];
        const FilterSeparation& b = error.part.components[k];
        for (int i = 0; i < FilterSeparation::kComponents; ++i) {
          ASSERT_EQ(std::isnan(a.sigma(i)), std::isnan(b.sigma(i))) << k;
          if (std::isnan(a.sigma(i))) continue;
          EXPECT_NEAR(a.difference(i) / a.sigma(i),
                      b.difference(i) / b.sigma(i), 1e-3)
              << k << ' ' << i;
          EXPECT_NEAR(a.sigma(i) / b.sigma(i), 1.0, 1e-3) << k << ' ' << i;
        }
      }
    }
  }
}

TEST(TwoFilter, EulerChartAgreesToSecondOrderInTheErrors) {
  // A tenth of the errors leaves a hundredth of the difference.
  double difference[2];
  for (int i = 0; i < 2; ++i) {
    TestProblemOptions options;
    options.noise = TacticalNoise(false);
    NavigationPrior prior;
    const double size = i == 0 ? 1.0 : 0.1;
    prior.position_sigma.setConstant(size);
    prior.velocity_sigma.setConstant(0.1 * size);
    prior.attitude_sigma.setConstant(2.0 * size * kDegree);
    prior.gyro_bias_sigma.setConstant(1e-5 * size);
    prior.accel_bias_sigma.setConstant(1e-2 * size);
    options.noise.gyro_noise_density *= size;
    options.noise.accel_noise_density *= size;
    options.position_sigma *= size;
    options.velocity_sigma *= size;
    options.layout = NavigationLayout(prior);
    options.errors = true;
    const TestProblem problem = MakeProblem(options, 3);
    Problem posed = problem.Pose();
    const LinearTape tape = RunExtendedKalmanFilter(&posed);
    difference[i] = LargestError(
        problem.layout, SmoothTwoFilter(tape).trajectory.states,
        SmoothTwoFilterConventional(tape, ChartKind::kEuler).trajectory.states,
        BlockKind::kPosition);
  }
  EXPECT_GT(difference[0], 1e-6);
  EXPECT_LT(difference[1], 0.03 * difference[0]);
}

TEST(TwoFilter, SeparationIsChiSquare) {
  // Mean square of 3 over the runs at an epoch in the middle, of 1 of each
  // component; the bounds are four standard deviations of a mean of so many
  // chi-squares of 3 and of 1.
  constexpr int kRuns = testing::SeedCount(60);
  double sum = 0.0;
  FilterSeparation::Components sums = FilterSeparation::Components::Zero();
  for (int run = 0; run < kRuns; ++run) {
    TestProblemOptions options;
    options.noise = TacticalNoise(true);
    options.layout = TypicalLayout(options.noise);
    options.errors = true;
    const TestProblem problem =
        MakeProblem(options, static_cast<std::uint64_t>(run) + 100);
    Problem posed = problem.Pose();
    const TwoFilterResult result =
        SmoothTwoFilter(RunExtendedKalmanFilter(&posed));
    sum += result.part.separation[10] * result.part.separation[10];
    const FilterSeparation& components = result.part.components[10];
    sums += components.difference.cwiseQuotient(components.sigma).cwiseAbs2();
  }
  EXPECT_NEAR(sum / kRuns, 3.0, 4.0 * std::sqrt(6.0 / kRuns));
  for (int i = 0; i < FilterSeparation::kComponents; ++i) {
    EXPECT_NEAR(sums(i) / kRuns, 1.0, 4.0 * std::sqrt(2.0 / kRuns)) << i;
  }
}

TEST(TwoFilter, AHeadingThatSplitsShowsInItsOwnComponent) {
  // The filter starts half a radian off and is sure of it: what comes later
  // says otherwise of the heading, and next to nothing of the position.
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  TestProblem problem = MakeProblem(options, 5);
  const Block& attitude = *problem.layout.Find(BlockKind::kAttitude);
  ErrorVector turn = ErrorVector::Zero(problem.layout.dim());
  turn(attitude.offset + 2) = 0.5;
  problem.prior.x = Retract(problem.layout, problem.prior.x, turn);
  Problem posed = problem.Pose();
  const TwoFilterResult result =
      SmoothTwoFilter(RunExtendedKalmanFilter(&posed));
  const FilterSeparation& first = result.part.components.front();
  EXPECT_GT(std::abs(first.difference(8) / first.sigma(8)), 3.0);
  EXPECT_NEAR(std::abs(first.difference(8)), 0.5, 0.2);
}

TEST(TwoFilter, TheBackwardSideAloneFusesToTheSmoothedConstants) {
  // Information adds: 1 / P_s = 1 / P_f + 1 / P_b cannot hold of a component
  // alone, but the backward side is never surer than both together.
  const TestProblem problem = NoisyProblem(true, true);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const TwoFilterResult result = SmoothTwoFilter(tape);
  ASSERT_EQ(result.part.backward.size(), tape.size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const OneSidedState& alone = result.part.backward[k];
    EXPECT_EQ(alone.state.t, tape.epoch(k).t);
    for (int i = 0; i < static_cast<int>(alone.sigma.size()); ++i) {
      if (std::isnan(alone.sigma(i))) continue;
      EXPECT_GT(alone.sigma(i) * (1.0 + 1e-6),
                std::sqrt(result.trajectory.P.Get(k)(i, i)))
          << k << ' ' << i;
    }
  }
  EXPECT_TRUE(result.part.backward.back().sigma.array().isNaN().all());
}

TEST(TwoFilter, NoSeparationWhereTheFutureKnowsNoPosition) {
  const TestProblem problem = NoisyProblem(false, true);
  Problem posed = problem.Pose();
  const TwoFilterResult result =
      SmoothTwoFilter(RunExtendedKalmanFilter(&posed));
  ASSERT_EQ(result.part.separation.size(), problem.nodes.size());
  EXPECT_TRUE(std::isnan(result.part.separation.back()));
  EXPECT_TRUE(std::isfinite(result.part.separation.front()));
  EXPECT_TRUE(result.part.components.back().difference.array().isNaN().all());
  EXPECT_TRUE(result.part.components.front().difference.allFinite());
}

}  // namespace
}  // namespace hindsight
