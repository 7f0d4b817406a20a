#include "timeline/time_update.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

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
  for (const auto kind : {BlockKind::kSensorError, BlockKind::kErrorRate}) {
    Block block;
    block.key = {kind, 0};
    block.evolution = Evolution::GaussMarkov(1.0, 100.0);
    block.sigma0.setConstant(0.5);
    options.layout.Add(block);
  }
  options.duration = 3.0;
  return MakeProblem(options, 1);
}

/// A drift that began before the first interval, another error over the second.
std::vector<std::vector<BlockStep>> Steps() {
  const BlockKey e = {BlockKind::kSensorError, 0};
  const BlockKey r = {BlockKind::kErrorRate, 0};
  return {
      {{.key = e, .phi = 1.0, .variance = 1e-6, .rate = r, .rate_share = 2.5},
       {r, 1.0, 4e-7}},
      {{.key = e, .phi = 0.9, .variance = 0.19, .down = 2.0}, {r, 0.0, 0.25}},
      {{e, 0.0, 1.0}, {r, 0.0, 0.25}}};
}

State WithError(const TestProblem& problem) {
  State x = problem.truth[0];
  const ErrorLayout& layout = problem.layout;
  const Block& e = *layout.Find(BlockKind::kSensorError, 0);
  const Block& r = *layout.Find(BlockKind::kErrorRate, 0);
  x.parameters.segment<3>(e.parameter_offset) << 1.0, 2.0, 3.0;
  x.parameters.segment<3>(r.parameter_offset) << 0.1, -0.2, 0.3;
  return x;
}

TEST(TimeUpdate, TakesTheStepsOfTheTimelineInPlaceOfEvolutions) {
  const TestProblem problem = DriftingProblem();
  Timeline timeline = problem.MakeTimeline();
  timeline.SetBlockSteps(Steps());
  const ErrorLayout& layout = problem.layout;
  const Block& e = *layout.Find(BlockKind::kSensorError, 0);
  const Block& r = *layout.Find(BlockKind::kErrorRate, 0);
  const State x = WithError(problem);
  const NodeInterval drifting = IntervalAfter(0, layout, x, &timeline);
  const State next = Advance(layout, drifting, x);
  const Eigen::Vector3d moved = next.parameters.segment<3>(e.parameter_offset);
  EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(1.25, 1.5, 3.75), 1e-12));
  Transition transition;
  LinearizeAdvance(layout, drifting, x, next, &transition);
  EXPECT_LT(transition.c.norm(), 1e-6);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset + 1, r.offset + 1),
                   2.5 * drifting.summary.dt());
  EXPECT_DOUBLE_EQ(transition.Phi(r.offset, r.offset), 1.0);
  EXPECT_DOUBLE_EQ(transition.Q(r.offset, r.offset), 4e-7);
  const NodeInterval biased = IntervalAfter(1, layout, x, &timeline);
  LinearizeAdvance(layout, biased, next, Advance(layout, biased, next),
                   &transition);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset, e.offset), 0.9);
  EXPECT_DOUBLE_EQ(transition.Phi(e.offset, r.offset), 0.0);
  EXPECT_DOUBLE_EQ(transition.Phi(r.offset, r.offset), 0.0);
  EXPECT_DOUBLE_EQ(transition.Q(r.offset, r.offset), 0.25);
  EXPECT_DOUBLE_EQ(transition.Q(e.offset + 1, e.offset + 1), 0.19);
  EXPECT_DOUBLE_EQ(transition.Q(e.offset + 2, e.offset + 2), 0.76);
}

/// So that what is sampled between nodes goes on to the next of them.
TEST(TimeUpdate, OfTwoPartsIsThatOfTheWhole) {
  const TestProblem problem = DriftingProblem();
  Timeline timeline = problem.MakeTimeline();
  timeline.SetBlockSteps(Steps());
  const ErrorLayout& layout = problem.layout;
  ImuIntegrator integrator(problem.imu);
  for (std::size_t k = 0; k < 3; ++k) {
    State x = WithError(problem);
    x.t = timeline.node(k).t;
    const auto part = [&](double from, double to) {
      return integrator.Summarize(x.t + from, x.t + to,
                                  CalibrationOf(layout, x));
    };
    const ImuSummary all = part(0.0, 1.0);
    const ImuSummary first = part(0.0, 0.4);
    const ImuSummary second = part(0.4, 1.0);
    const State whole = Advance(layout, {timeline, k, all}, x);
    const State middle = Advance(layout, {timeline, k, first}, x);
    const State end = Advance(layout, {timeline, k, second}, middle);
    EXPECT_TRUE(end.parameters.isApprox(whole.parameters, 1e-12)) << k;
    Transition a, b, ab;
    LinearizeAdvance(layout, {timeline, k, first}, x, middle, &a);
    LinearizeAdvance(layout, {timeline, k, second}, middle, end, &b);
    LinearizeAdvance(layout, {timeline, k, all}, x, whole, &ab);
    for (const BlockKind kind :
         {BlockKind::kSensorError, BlockKind::kErrorRate}) {
      const int i = layout.Find(kind, 0)->offset;
      const ErrorMatrix Phi = b.Phi * a.Phi;
      EXPECT_TRUE(Phi.row(i).isApprox(ab.Phi.row(i), 1e-12)) << k;
      const ErrorMatrix Q = b.Phi * a.Q * b.Phi.transpose() + b.Q;
      // The walk of a rate moves what it drives by its own order.
      EXPECT_NEAR(Q(i, i), ab.Q(i, i), 1e-6) << k;
    }
  }
}

Eigen::Matrix2d AsMatrix(const VelocityStep::Noise& noise) {
  return Eigen::Matrix2d({{noise.pp, noise.pv}, {noise.pv, noise.vv}});
}

/// By whatever times the interval from 10 to 14 s is cut.
TEST(VelocityStep, PartsMakeUpTheWhole) {
  constexpr double kBegin = 10.0;
  constexpr double kEnd = 14.0;
  constexpr double kBefore = -std::numeric_limits<double>::infinity();
  for (const auto& [begin, end] : {std::pair{10.0, 14.0},
                                   {11.0, 12.0},
                                   {10.0, 10.0},
                                   {12.5, 12.5},
                                   {6.0, 11.0},
                                   {6.0, 7.0}}) {
    const VelocityStep step = {.variance = 9.0, .begin = begin, .end = end};
    const Eigen::Matrix2d whole = AsMatrix(step.Within(kBefore, kEnd));
    EXPECT_DOUBLE_EQ(whole(1, 1), 9.0);
    EXPECT_DOUBLE_EQ(whole(0, 1), 9.0 * (kEnd - (begin + end) / 2.0));
    for (const double cut : {kBegin + 0.5, 11.0, 12.5, 13.9}) {
      Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
      F(0, 1) = kEnd - cut;
      const Eigen::Matrix2d parts =
          F * AsMatrix(step.Within(kBefore, cut)) * F.transpose() +
          AsMatrix(step.Within(cut, kEnd));
      EXPECT_TRUE(parts.isApprox(whole, 1e-12))
          << begin << " " << end << " " << cut;
    }
  }
}

TEST(TimeUpdate, AddsTheVelocityStepsOfTheTimeline) {
  const TestProblem problem = DriftingProblem();
  Timeline timeline = problem.MakeTimeline();
  const ErrorLayout& layout = problem.layout;
  const State x = WithError(problem);
  const NodeInterval interval = IntervalAfter(0, layout, x, &timeline);
  const State next = Advance(layout, interval, x);
  Transition before;
  LinearizeAdvance(layout, interval, x, next, &before);
  const double t = timeline.node(0).t;
  const double dt = interval.summary.dt();
  // One at its begin, one that may have been before, and one behind it.
  timeline.AddVelocityStep({4.0, t, t});
  timeline.AddVelocityStep({18.0, t - dt, t + dt});
  timeline.AddVelocityStep({25.0, t + dt, t + dt});
  Transition after;
  LinearizeAdvance(layout, interval, x, next, &after);
  EXPECT_EQ(after.Phi, before.Phi);
  EXPECT_EQ(after.c, before.c);
  const ErrorMatrix added = after.Q - before.Q;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const int p = layout.Find(BlockKind::kPosition)->offset;
  const int v = layout.Find(BlockKind::kVelocity)->offset;
  // But for the curvature of the Earth and its rate, in a second.
  constexpr double kNearly = 1e-3;
  EXPECT_TRUE((added.block<3, 3>(p, p).isApprox((4.0 + 9.0 / 3.0) * dt * dt * I,
                                                kNearly)));
  EXPECT_TRUE(
      (added.block<3, 3>(p, v).isApprox((4.0 + 9.0 / 2.0) * dt * I, kNearly)));
  EXPECT_TRUE((added.block<3, 3>(v, v).isApprox(13.0 * I, kNearly)));
  EXPECT_LT(added.bottomRows(layout.dim() - 6).norm(), 1e-12);
}

/// Models about one nominal differ in what they believe of the parameters.
TEST(TimeUpdate, BesideItsOwnNavigationStateIsTheUpdate) {
  const TestProblem problem = DriftingProblem();
  Timeline timeline = problem.MakeTimeline();
  timeline.SetBlockSteps(Steps());
  const State x = WithError(problem);
  const NodeInterval interval = IntervalAfter(1, problem.layout, x, &timeline);
  const State next = Advance(problem.layout, interval, x);
  const State beside = AdvanceBeside(next, problem.layout, interval, x);
  EXPECT_EQ(beside.parameters, next.parameters);
  EXPECT_EQ(beside.p_e, next.p_e);
  EXPECT_EQ(beside.t, next.t);
}

}  // namespace
}  // namespace hindsight
