#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "filters/tape_states.h"
#include "filters/two_filter.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::LargestError;
using testing::MakeProblem;
using testing::ScaledDifference;
using testing::StatesAfter;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;

constexpr ErrorDefinition kErrors[] = {ErrorDefinition::kNavigation,
                                       ErrorDefinition::kQuaternion,
                                       ErrorDefinition::kLeftInvariant};

/// Errors of the start: `scale` times a degree and the like.
TestProblem ShortDrive(bool errors, double scale = 1.0) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  NavigationPrior prior;
  prior.position_sigma.setConstant(0.5 * scale);
  prior.velocity_sigma.setConstant(0.2 * scale);
  prior.attitude_sigma.setConstant(kDegree * scale);
  prior.gyro_bias_sigma.setConstant(1e-4);
  prior.accel_bias_sigma.setConstant(0.01);
  prior.gyro_bias = options.noise.GyroBiasEvolution();
  prior.accel_bias = options.noise.AccelBiasEvolution();
  options.layout = NavigationLayout(prior);
  options.errors = errors;
  return MakeProblem(options);
}

LinearTape RunModel(const TestProblem& problem, const ForwardModel& model) {
  Problem posed = problem.Pose();
  return RunForwardFilter(model, &posed);
}

ForwardModel HInfinityModel(double gamma) {
  ForwardModel model;
  model.covariance.rule = RiccatiRule::kHInfinity;
  model.covariance.gamma = gamma;
  return model;
}

TEST(Observer, ExactDataGiveZeroErrorByEveryRuleAndError) {
  const TestProblem problem = ShortDrive(false);
  ForwardModel modified;
  modified.covariance.rule = RiccatiRule::kModifiedHInfinity;
  modified.covariance.alpha = 0.03;
  modified.covariance.delta = 0.01;
  for (ForwardModel model : {ForwardModel{}, HInfinityModel(10.0), modified}) {
    for (const ErrorDefinition error : kErrors) {
      model.error = error;
      const LinearTape tape = RunModel(problem, model);
      const std::vector<State> states = StatesAfter(tape);
      EXPECT_LT(LargestError(problem.layout, states, problem.truth,
                             BlockKind::kPosition),
                1e-7);
      EXPECT_LT(LargestError(problem.layout, states, problem.truth,
                             BlockKind::kAttitude),
                1e-9);
    }
  }
}

TEST(Observer, GammaToInfinityIsTheKalmanFilter) {
  const TestProblem problem = ShortDrive(true);
  const LinearTape kalman = RunModel(problem, {});
  const LinearTape infinite = RunModel(
      problem, HInfinityModel(std::numeric_limits<double>::infinity()));
  const LinearTape large = RunModel(problem, HInfinityModel(1e6));
  for (std::size_t k = 0; k < kalman.size(); ++k) {
    EXPECT_EQ(kalman.P_plus(k), infinite.P_plus(k));
    EXPECT_EQ(kalman.epoch(k).x_plus.p_e, infinite.epoch(k).x_plus.p_e);
    // theta = 1e-12 of attitudes known to 0.02 rad: nothing but rounding.
    EXPECT_LT(ScaledDifference(large.P_plus(k), kalman.P_plus(k)), 1e-11);
    EXPECT_LT((kalman.epoch(k).x_plus.p_e - large.epoch(k).x_plus.p_e).norm(),
              1e-8);
  }
}

TEST(Observer, HInfinityIsMoreCautiousThanKalman) {
  const TestProblem problem = ShortDrive(true);
  const LinearTape kalman = RunModel(problem, {});
  const LinearTape bounded = RunModel(problem, HInfinityModel(0.1));
  for (std::size_t k = 1; k < kalman.size(); ++k) {
    const Eigen::Vector3d difference =
        (bounded.P_plus(k) - kalman.P_plus(k)).diagonal().segment<3>(6);
    EXPECT_GT(difference.minCoeff(), 0.0) << k;
  }
}

TEST(Observer, EscapesWithItsTimeAndNeverWithoutANumber) {
  TestProblem problem = ShortDrive(true);
  for (Measurement& z : problem.measurements) z.withheld = true;
  ForwardModel model = HInfinityModel(0.05);
  const double expected =
      0.05 * 0.05 / std::pow(kDegree, 2);  // gamma^2 / P0, but for Q
  ASSERT_LT(expected, 15.0);
  try {
    RunModel(problem, model);
    FAIL() << "no escape";
  } catch (const FiniteEscape& escape) {
    EXPECT_LT(escape.t(), expected + 1e-6);
    EXPECT_GT(escape.t(), 0.5 * expected);
  }
  model.covariance.back_off = true;
  const LinearTape tape = RunModel(problem, model);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    EXPECT_TRUE(tape.P_plus(k).allFinite());
  }
}

TEST(Observer, ErrorDefinitionsAgreeToSecondOrderInTheErrors) {
  double previous = 0.0;
  for (const double scale : {1.0, 0.1}) {
    const TestProblem problem = ShortDrive(true, scale);
    const std::vector<State> navigation = StatesAfter(RunModel(problem, {}));
    double largest = 0.0;
    for (const ErrorDefinition error :
         {ErrorDefinition::kQuaternion, ErrorDefinition::kLeftInvariant}) {
      ForwardModel model;
      model.error = error;
      const double difference =
          LargestError(problem.layout, StatesAfter(RunModel(problem, model)),
                       navigation, BlockKind::kAttitude);
      EXPECT_GT(difference, 0.0);
      largest = std::max(largest, difference);
    }
    EXPECT_LT(largest, 3.0 * std::pow(scale * kDegree, 2));
    // Ten times smaller errors, a hundred times smaller difference; noise does
    // not shrink with the start, so half an order is allowed for it.
    if (scale < 1.0) {
      EXPECT_LT(largest, 0.03 * previous);
    }
    previous = largest;
  }
}

TEST(Observer, SmoothersFollowTheErrorDefinitionOfTheTape) {
  const TestProblem problem = ShortDrive(true);
  for (const ErrorDefinition error : kErrors) {
    ForwardModel model;
    model.error = error;
    const LinearTape tape = RunModel(problem, model);
    const SmoothedTrajectory rts = SmoothRts(tape);
    const SmoothedTrajectory two = SmoothTwoFilter(tape).trajectory;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const ErrorVector d = Local(problem.layout, rts.states[k], two.states[k]);
      EXPECT_LT(d.head<3>().cwiseAbs().maxCoeff(), 1e-7) << ErrorName(error);
      EXPECT_LT(ScaledDifference(rts.P.Get(k), two.P.Get(k)), 1e-6);
    }
  }
}

TEST(Observer, TapesOfOtherRulesAreNotSmoothed) {
  const TestProblem problem = ShortDrive(true);
  const LinearTape tape = RunModel(problem, HInfinityModel(1.0));
  EXPECT_FALSE(tape.smoothable());
  EXPECT_THROW(SmoothRts(tape), std::logic_error);
  EXPECT_THROW(SmoothTwoFilter(tape), std::logic_error);
}

}  // namespace
}  // namespace hindsight
