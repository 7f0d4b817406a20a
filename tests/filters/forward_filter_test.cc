#include "filters/forward_filter.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "base/error.h"
#include "filters/iterated_smoother.h"
#include "filters/rts.h"
#include "filters/tape_states.h"
#include "support/seed_count.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::LargestError;
using testing::MakeProblem;
using testing::RichLayout;
using testing::StatesAfter;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblemOptions Options(bool errors, bool rich = false) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout =
      rich ? RichLayout(options.noise) : TypicalLayout(options.noise);
  options.errors = errors;
  return options;
}

void ExpectEqualTrajectories(const ErrorLayout& layout,
                             const std::vector<State>& a,
                             const std::vector<State>& b) {
  ASSERT_EQ(a.size(), b.size());
  // The quadrature of gravitation over the 1 s between nodes is below 5e-7;
  // here both sides use the same intervals: rounding of 6.4e6 m over 20 steps.
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kPosition), 1e-7);
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kVelocity), 1e-7);
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kAttitude), 1e-9);
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kGyroBias), 1e-9);
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kAccelBias), 1e-7);
}

TEST(ForwardFilter, ExactDataGiveZeroError) {
  for (const bool rich : {false, true}) {
    const TestProblem problem = MakeProblem(Options(false, rich));
    Problem posed = problem.Pose();
    const LinearTape tape = RunExtendedKalmanFilter(&posed);
    ExpectEqualTrajectories(problem.layout, StatesAfter(tape), problem.truth);
    ExpectEqualTrajectories(problem.layout, SmoothRts(tape).states,
                            problem.truth);
  }
}

TEST(ForwardFilter, IteratedSmootherOfExactDataReturnsToTheTruth) {
  const TestProblem problem = MakeProblem(Options(false));
  Problem posed = problem.Pose(GateDecisions(problem.measurements.size(), 1));
  std::vector<State> nominal = problem.truth;
  Random random(7);
  for (State& x : nominal) {
    ErrorVector d = testing::Draw(problem.layout.InitialCovariance(), &random);
    // Summaries are corrected to first order in the biases: c^2/2 of a turn by
    // c = 1e-5 rad is out of sight, that of the whole prior would be 1e-6 m/s.
    d.tail<6>() *= 0.01;
    x = Retract(problem.layout, x, d);
  }
  const IteratedResult result = SmoothIterated(nominal, {}, &posed);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, 6);
  ExpectEqualTrajectories(problem.layout, result.trajectory.states,
                          problem.truth);
}

TEST(ForwardFilter, IterationStopsWhereTheRestIsNegligible) {
  const TestProblem problem = MakeProblem(Options(true), 4);
  Problem posed = problem.Pose(GateDecisions(problem.measurements.size(), 1));
  std::vector<State> nominal = problem.truth;
  Random random(8);
  for (State& x : nominal) {
    x = Retract(problem.layout, x,
                testing::Draw(problem.layout.InitialCovariance(), &random));
  }
  const auto smooth = [&](const CovarianceSeries* rough) {
    IterationOptions options;
    options.rough = rough;
    return SmoothIterated(nominal, options, &posed);
  };
  const IteratedResult whole = smooth(nullptr);
  const IteratedResult soon = smooth(&whole.trajectory.P);
  EXPECT_TRUE(whole.converged && soon.converged);
  EXPECT_LT(soon.iterations, whole.iterations);
  EXPECT_TRUE(soon.trajectory.P.empty());
  EXPECT_LT(LargestMoveInSigmas(problem.layout, soon.trajectory.states,
                                whole.trajectory.states, whole.trajectory.P),
            kNegligibleRest);
  EXPECT_NEAR(soon.log_likelihood, whole.log_likelihood, 1e-3);
}

/// The likelihood that a profile compares: as settled as the smoother's, for less.
TEST(SettledLogLikelihood, IsWhatTheIteratedSmootherComesTo) {
  const TestProblem problem = MakeProblem(Options(true), 4);
  const GateDecisions all(problem.measurements.size(), 1);
  std::vector<State> nominal = problem.truth;
  Random random(8);
  for (State& x : nominal) {
    x = Retract(problem.layout, x,
                testing::Draw(problem.layout.InitialCovariance(), &random));
  }
  Problem smoothed = problem.Pose(all);
  const IteratedResult settled = SmoothIterated(nominal, {}, &smoothed);
  ASSERT_TRUE(settled.converged);
  Problem posed = problem.Pose(all);
  const double first = LogLikelihoodOf(RunLinearizedFilter(nominal, &posed));
  const double found = SettledLogLikelihood(nominal, &posed);
  EXPECT_NEAR(found, settled.log_likelihood, 0.01);
  EXPECT_GT(std::abs(first - found), 0.1);
}

TEST(ForwardFilter, TapeTransitionIsTheDerivativeOfPropagation) {
  const TestProblem problem = MakeProblem(Options(true, true));
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  for (const std::size_t k : {std::size_t{1}, tape.size() - 1}) {
    const State& x = tape.epoch(k - 1).x_plus;
    const State& y = tape.epoch(k).x_minus;
    const auto propagate = [&](const ErrorVector& d) {
      return Local(problem.layout, y,
                   Predict(problem.layout, Retract(problem.layout, x, d),
                           posed.timeline.Summary(k - 1)));
    };
    for (int c = 0; c < problem.layout.dim(); ++c) {
      // Rounding of positions, 2e-9 m over 2 h; curvature h^2/6 |dp| < 1e-7.
      const double h = c < 3 ? 1.0 : 1e-4;
      const double tolerance = c < 3 ? 1e-8 : 5e-5;
      ErrorVector step = ErrorVector::Zero(problem.layout.dim());
      step(c) = h;
      const ErrorVector column = (propagate(step) - propagate(-step)) / (2 * h);
      EXPECT_LT((column - tape.Phi(k).col(c)).cwiseAbs().maxCoeff(), tolerance)
          << problem.layout.ComponentName(c);
    }
  }
}

TEST(ForwardFilter, ContinuedRunEqualsTheWholeRun) {
  const TestProblem problem = MakeProblem(Options(true));
  Problem whole = problem.Pose();
  const LinearTape all = RunExtendedKalmanFilter(&whole);
  constexpr std::size_t kCut = 8;
  TestProblem first = problem;
  first.nodes.resize(kCut + 1);
  Problem begin = first.Pose();
  const LinearTape head = RunExtendedKalmanFilter(&begin);
  TestProblem second = problem;
  second.nodes.erase(second.nodes.begin(), second.nodes.begin() + kCut);
  second.nodes.front().measurement_count = 0;  // used already
  Problem rest = second.Pose();
  rest.prior = {head.back().x_plus, head.P_plus(head.size() - 1)};
  const LinearTape tail = RunExtendedKalmanFilter(&rest);
  ASSERT_EQ(tail.size(), all.size() - kCut);
  for (std::size_t k = 1; k < tail.size(); ++k) {
    // The same operations on the same numbers.
    EXPECT_EQ(tail.epoch(k).x_plus.p_e, all.epoch(k + kCut).x_plus.p_e) << k;
    EXPECT_EQ(tail.P_plus(k), all.P_plus(k + kCut)) << k;
  }
}

TEST(ForwardFilter, TwoRunsGiveIdenticalBits) {
  const TestProblem problem = MakeProblem(Options(true, true));
  Problem a = problem.Pose();
  Problem b = problem.Pose();
  const LinearTape tape_a = RunExtendedKalmanFilter(&a);
  const LinearTape tape_b = RunExtendedKalmanFilter(&b);
  for (std::size_t k = 0; k < tape_a.size(); ++k) {
    EXPECT_EQ(tape_a.epoch(k).x_plus.q_eb.coeffs(),
              tape_b.epoch(k).x_plus.q_eb.coeffs());
    EXPECT_EQ(tape_a.P_plus(k), tape_b.P_plus(k));
  }
}

TEST(ForwardFilter, GateRejectsAnOutlierAndRecordsIt) {
  TestProblem problem = MakeProblem(Options(true));
  problem.sensors[0].gate_probability = 0.9999;
  constexpr std::size_t kOutlier = 10;
  const auto index =
      static_cast<std::size_t>(problem.nodes[kOutlier].first_measurement);
  auto& fix = std::get<PositionFix>(problem.measurements[index].model);
  fix.p_e += Eigen::Vector3d(3.0, 3.0, 3.0);
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const TapeMeasurement& rejected = tape.measurements(kOutlier)[0];
  EXPECT_FALSE(rejected.accepted);
  EXPECT_GT(rejected.nis, GateLimit(problem.sensors[0], 3));
  int count = 0;
  for (const char accepted : DecisionsOnTape(tape)) count += accepted == 0;
  EXPECT_EQ(count, 1);
  // Rejected is as good as never measured.
  TestProblem without = problem;
  without.measurements[index].withheld = true;
  Problem other = without.Pose();
  const LinearTape expected = RunExtendedKalmanFilter(&other);
  EXPECT_TRUE(expected.measurements(kOutlier)[0].withheld);
  EXPECT_FALSE(expected.measurements(kOutlier)[0].accepted);
  EXPECT_EQ(tape.back().x_plus.p_e, expected.back().x_plus.p_e);
  EXPECT_EQ(tape.P_plus(tape.size() - 1), expected.P_plus(expected.size() - 1));
}

TEST(ForwardFilter, WeightOfALossIsOnTheTapeAndDividesR) {
  TestProblem problem = MakeProblem(Options(true));
  constexpr std::size_t kOutlier = 10;
  const auto index =
      static_cast<std::size_t>(problem.nodes[kOutlier].first_measurement);
  auto& fix = std::get<PositionFix>(problem.measurements[index].model);
  const double variance = fix.R_n(0, 0);
  fix.p_e += Eigen::Vector3d(3.0, 3.0, 3.0);
  RobustLoss& loss = problem.sensors[0].loss;
  loss.kind = RobustLoss::Kind::kMixture;
  loss.scale = 1.0;
  loss.rows = 1;  // those of the measurement count
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  const TapeMeasurement& outlier = tape.measurements(kOutlier)[0];
  EXPECT_TRUE(outlier.accepted);
  EXPECT_NEAR(outlier.weight, 1.0 / 400.0, 1e-6);
  EXPECT_NEAR(outlier.R(0, 0), 400.0 * variance, 1e-3 * variance);
  // ln of the odds of an inlier at s = 0, for three rows.
  const double odds = 0.95 / 0.05 * std::pow(20.0, 3);
  const TapeMeasurement& good = tape.measurements(kOutlier + 5)[0];
  EXPECT_GT(good.weight, 1.0 - 100.0 / odds * std::exp(0.5 * good.nis));
  EXPECT_LT(good.weight, 1.0);
  EXPECT_NEAR(loss.OfRows(3).Weight(0.0),
              1.0 - (1.0 - 1.0 / 400.0) / (1.0 + odds), 1e-12);
}

TEST(ForwardFilter, GateLimitIsTheChiSquareQuantile) {
  Sensor sensor;
  EXPECT_EQ(GateLimit(sensor, 3), std::numeric_limits<double>::infinity());
  sensor.gate_probability = 0.95;
  EXPECT_NEAR(GateLimit(sensor, 1), 3.841458820694124, 1e-9);
  EXPECT_NEAR(GateLimit(sensor, 3), 7.814727903251179, 1e-9);
}

TEST(ForwardFilter, GivenDecisionsReplaceTheGate) {
  TestProblem problem = MakeProblem(Options(true));
  problem.sensors[0].gate_probability = 1e-12;  // would reject everything
  GateDecisions decisions(problem.measurements.size(), 1);
  decisions[4] = 0;
  Problem posed = problem.Pose(decisions);
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  EXPECT_EQ(DecisionsOnTape(tape), decisions);
}

TEST(ForwardFilter, NisAveragesItsDegreesOfFreedom) {
  // Innovations of a right filter are white: sums over time and runs are
  // chi-square.
  double sum = 0.0;
  double dof = 0.0;
  constexpr auto kSeeds = static_cast<std::uint64_t>(testing::SeedCount(60));
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const TestProblem problem = MakeProblem(Options(true), seed);
    Problem posed = problem.Pose();
    const LinearTape tape = RunExtendedKalmanFilter(&posed);
    for (std::size_t k = 1; k < tape.size(); ++k) {
      for (const TapeMeasurement& z : tape.measurements(k)) {
        sum += z.nis;
        dof += static_cast<double>(z.residual.size());
      }
    }
  }
  const boost::math::chi_squared distribution(dof);
  EXPECT_GT(sum, boost::math::quantile(distribution, 0.025));
  EXPECT_LT(sum, boost::math::quantile(distribution, 0.975));
}

TEST(ForwardFilter, CallbackSeesEveryEpochAndMayStop) {
  const TestProblem problem = MakeProblem(Options(false));
  Problem posed = problem.Pose();
  std::size_t last = 0;
  EXPECT_THROW(RunExtendedKalmanFilter(&posed,
                                       [&last](std::size_t done) {
                                         last = done;
                                         if (done == 5) throw Interrupted();
                                       }),
               Interrupted);
  EXPECT_EQ(last, 5u);
}

}  // namespace
}  // namespace hindsight
