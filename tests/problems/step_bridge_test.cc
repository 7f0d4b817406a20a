#include "problems/step_bridge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TestProblem;

TestProblem Drive() {
  testing::TestProblemOptions options;
  options.layout = NavigationLayout({});
  return MakeProblem(options);
}

/// Of steps of any size at any time of a window that begins before the interval.
TEST(StepBridge, HasTheMeanSquareOfWhatItLeavesOpen) {
  const TestProblem problem = Drive();
  Timeline timeline = problem.MakeTimeline();
  const double begin = timeline.node(1).t;
  const double T = timeline.node(2).t - begin;
  EXPECT_FALSE(BridgeOverSteps(problem.layout, timeline, 1, begin + 0.5 * T));
  const VelocityStep step = {4.0, begin - 0.5 * T, begin + 0.5 * T};
  timeline.AddVelocityStep(step);
  EXPECT_FALSE(BridgeOverSteps(ErrorLayout(), timeline, 1, begin + 0.5 * T));
  Random random(5);
  constexpr int kDraws = 20000;
  for (const double part : {0.1, 0.25, 0.4, 0.9}) {
    const double t = begin + part * T;
    const StepBridge bridge =
        BridgeOverSteps(problem.layout, timeline, 1, t).value();
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (int i = 0; i < kDraws; ++i) {
      const double at = step.begin + (step.end - step.begin) * random.Uniform();
      const double dv = std::sqrt(step.variance) * random.Normal();
      const auto moved = [&](double to) -> Eigen::Vector2d {
        return at < begin || to < at ? Eigen::Vector2d(0.0, 0.0)
                                     : Eigen::Vector2d(dv * (to - at), dv);
      };
      const Eigen::Vector2d e = moved(t) - bridge.gain * moved(begin + T);
      sum += e * e.transpose();
    }
    EXPECT_LT((sum / kDraws - bridge.covariance).norm(),
              0.05 * bridge.covariance.norm() + 1e-6)
        << part;
  }
  const StepBridge end =
      BridgeOverSteps(problem.layout, timeline, 1, begin + T).value();
  EXPECT_LT((end.gain - Eigen::Matrix2d::Identity()).norm(), 1e-6);
  EXPECT_LT(end.covariance.norm(), 1e-6);
  const StepBridge start =
      BridgeOverSteps(problem.layout, timeline, 1, begin).value();
  EXPECT_EQ(start.gain, Eigen::Matrix2d::Zero());
  EXPECT_EQ(start.covariance, Eigen::Matrix2d::Zero());
}

/// Whose time is known, which leaves nothing open.
TEST(StepBridge, OfOneTimeIsTheStep) {
  const TestProblem problem = Drive();
  const Timeline without = problem.MakeTimeline();
  const double begin = without.node(1).t;
  const double T = without.node(2).t - begin;
  for (const double at : {0.0, 0.4}) {
    Timeline timeline = without;
    timeline.AddVelocityStep({4.0, begin + at * T, begin + at * T});
    for (const double part : {0.2, 0.39, 0.7}) {
      const StepBridge bridge =
          BridgeOverSteps(problem.layout, timeline, 1, begin + part * T)
              .value();
      EXPECT_LT(bridge.covariance.norm(), 1e-6);
      const Eigen::Vector2d by_then =
          part < at ? Eigen::Vector2d(0.0, 0.0)
                    : Eigen::Vector2d(3.0 * (part - at) * T, 3.0);
      const Eigen::Vector2d by_end(3.0 * (1.0 - at) * T, 3.0);
      EXPECT_LT((bridge.gain * by_end - by_then).norm(), 1e-5)
          << at << " " << part;
    }
  }
}

}  // namespace
}  // namespace hindsight
