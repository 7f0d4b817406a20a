#include "imu/error_drift.h"

#include <gtest/gtest.h>

#include "imu/imu_link.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem DriftingProblem() {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  for (const auto kind : {BlockKind::kColouredNoise, BlockKind::kErrorRate}) {
    Block block;
    block.key = {kind, 0};
    block.evolution = Evolution::GaussMarkov(1.0, 100.0);
    block.sigma0.setConstant(0.5);
    options.layout.Add(block);
  }
  options.duration = 3.0;
  return MakeProblem(options, 1);
}

TEST(ErrorDrift, GrowsByItsRateWhereTheStepSaysSoAndElseDrawsTheRateAnew) {
  const TestProblem problem = DriftingProblem();
  Timeline timeline = problem.MakeTimeline();
  timeline.SetColouredSteps(
      {{0, 1.0, 1e-6, true}, {0, 0.9, 0.19}, {0, 0.0, 1.0}});
  const ErrorLayout& layout = problem.layout;
  const Block& e = *layout.Find(BlockKind::kColouredNoise, 0);
  const Block& r = *layout.Find(BlockKind::kErrorRate, 0);
  State x = problem.truth[0];
  x.parameters.segment<3>(e.parameter_offset) << 1.0, 2.0, 3.0;
  x.parameters.segment<3>(r.parameter_offset) << 0.1, -0.2, 0.3;
  const ImuSummary& drifting = timeline.Summary(0, CalibrationOf(layout, x));
  const State next = Predict(layout, x, drifting);
  const Eigen::Vector3d moved = next.parameters.segment<3>(e.parameter_offset);
  EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(1.1, 1.8, 3.3), 1e-12));
  Transition transition;
  LinearizeTransition(layout, drifting, x, next, &transition);
  EXPECT_LT(transition.c.norm(), 1e-6);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset + 1, r.offset + 1), drifting.dt());
  EXPECT_DOUBLE_EQ(transition.Phi(r.offset, r.offset), 1.0);
  EXPECT_DOUBLE_EQ(transition.Q(r.offset, r.offset),
                   0.25 * kDriftWalk * kDriftWalk * drifting.dt());
  const ImuSummary& biased = timeline.Summary(1, CalibrationOf(layout, x));
  LinearizeTransition(layout, biased, next, Predict(layout, next, biased),
                      &transition);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset, e.offset), 0.9);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset, r.offset), 0.0);
  EXPECT_DOUBLE_EQ(transition.Phi(r.offset, r.offset), 0.0);
  EXPECT_DOUBLE_EQ(transition.Q(r.offset, r.offset), 0.25);
}

}  // namespace
}  // namespace hindsight
