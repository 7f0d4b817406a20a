#include "receiver_errors/held_out_score.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/units.h"
#include "filters/rts.h"
#include "receiver_errors/receiver_tape.h"

namespace hindsight {
namespace {

using testing::AddError;
using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

/// Of good fixes, by a smoother that never had those of the stretch.
double WithoutThem(const TestProblem& problem, const LinearTape& tape,
                   const HeldOutStretch& stretch) {
  GateDecisions used(problem.measurements.size(), 1);
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) used[i] = 0;
  const SmoothedTrajectory rest = SmoothRts(TapeOf(problem, used));
  double sum = 0.0;
  for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
    const TapeMeasurement& z = tape.measurements(k)[0];
    const Eigen::Vector3d r = z.residual - z.H * rest.d[k];
    const Eigen::Matrix3d S = z.H * rest.P.Get(k) * z.H.transpose() + z.R;
    const double log =
        -0.5 * (r.dot(S.llt().solve(r)) + std::log(S.determinant()) +
                3.0 * std::log(2.0 * kPi));
    const double uniform = 0.01 / std::pow(200.0 * 0.5, 3);
    sum += std::log(0.99 * std::exp(log) + uniform);
  }
  return sum / static_cast<double>(stretch.end - stretch.begin);
}

TEST(HeldOutScore, OfGoodFixesIsThatOfASmootherWithoutThem) {
  const TestProblem problem = PositionsOnly(60.0);
  const LinearTape tape = TapeOf(problem);
  Hypothesis good;
  good.sequence = Good(tape);
  good.parameters = WithoutOutliers();
  const std::vector<HeldOutStretch> stretches = {{0, 3}, {20, 50}, {58, 61}};
  const std::vector<HeldOutScore> scores =
      ScoreHeldOut({tape, 0}, good, stretches);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    // The kept least sigma of a fix is the difference.
    EXPECT_NEAR(scores[i].log_density, WithoutThem(problem, tape, stretches[i]),
                1e-6)
        << i;
  }
}

/// Quantiles of Student's distribution at 97.725 %.
TEST(HeldOutScore, LosesByMoreStandardErrorsOfFewStretches) {
  EXPECT_NEAR(LimitOf(3), 4.527, 0.2);
  EXPECT_NEAR(LimitOf(5), 2.869, 0.02);
  EXPECT_NEAR(LimitOf(11), 2.284, 0.002);
  EXPECT_NEAR(LimitOf(41), 2.064, 0.002);
  HeldOutDifference d;
  d.log_distance = {2.5, 1.0};
  d.stretches = 40;
  EXPECT_TRUE(d.Loses());
  d.stretches = 5;
  EXPECT_FALSE(d.Loses());
}

TEST(HeldOutScore, StretchesAreEverywhereAndAtChangesWithoutOverlap) {
  const LinearTape tape = TapeOf(PositionsOnly(120.0));
  ModeSequence changed = Good(tape);
  for (std::size_t i = 50; i < 70; ++i)
    changed[i] = {ErrorMode::kBiased, i == 50};
  const std::vector<HeldOutStretch> all =
      HeldOutStretches({tape, 0}, 10.0, {&changed});
  ASSERT_GE(all.size(), 8u);
  EXPECT_EQ(all[0].begin, 45u);
  EXPECT_EQ(all[0].end, 55u);
  EXPECT_EQ(all[1].begin, 65u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(all[i].end <= all[j].begin || all[j].end <= all[i].begin);
    }
  }
}

Hypothesis Biased(const LinearTape& tape, std::size_t begin, std::size_t end) {
  Hypothesis one;
  one.sequence = Good(tape);
  one.parameters = WithoutOutliers();
  for (std::size_t i = begin; i < end; ++i) {
    one.sequence[i] = {ErrorMode::kBiased, i == begin};
  }
  return one;
}

TEST(HeldOutScore, PrefersABiasThatIsThereAndRefusesOneThatFitsNoise) {
  TestProblem problem = PositionsOnly(120.0);
  AddError(50, 80, {8.0, -6.0, 0.0}, &problem);
  const LinearTape tape = TapeOf(problem);
  Hypothesis good = Biased(tape, 0, 0);
  for (const HeldOutDifference& d :
       CompareHeldOut({tape, 0}, Biased(tape, 50, 80), good)) {
    EXPECT_GT(d.log_density.mean, 0.0) << d.length;
    EXPECT_FALSE(d.Loses()) << d.length;
  }
  // A receiver of a tenth of the noise whose every fix the IMU explains by a
  // step of its velocity.
  Hypothesis absurd = good;
  absurd.parameters.scale = 0.1;
  absurd.parameters.rate_sigma = 1.0;
  for (ErrorStep& step : absurd.sequence) step.velocity_step = true;
  const TestProblem healthy = PositionsOnly(120.0);
  const LinearTape clean = TapeOf(healthy);
  for (const HeldOutDifference& d : CompareHeldOut({clean, 0}, absurd, good)) {
    EXPECT_TRUE(d.LosesDensity()) << d.length;
  }
}

}  // namespace
}  // namespace hindsight
