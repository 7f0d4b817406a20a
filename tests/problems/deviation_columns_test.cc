#include "problems/deviation_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "filters/forward_filter.h"
#include "problems/likely_deviations.h"
#include "support/test_motion.h"
#include "support/test_problem.h"

namespace hindsight::testing {
namespace {

/// Of the scales of the gyros.
struct ScaleScores {
  std::vector<double> z;     ///< MeanShift::z
  std::vector<double> told;  ///< DeviationColumns::ZOf
};

/// Of a drive of ten minutes with noisy gyros that measure so much too much.
ScaleScores ScalesOf(double scale, unsigned seed) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.noise.gyro_noise_density = 0.01;
  options.layout = TypicalLayout(options.noise);
  options.duration = 600.0;
  options.spacing = 0.2;
  options.errors = true;
  TestProblem test = MakeProblem(options, seed);
  for (ImuSample& sample : test.imu.samples) sample.gyro *= 1.0 + scale;
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const DeviationColumns own(problem, test.truth, tape);
  const std::vector<std::size_t> onsets = {0};
  ScaleScores out;
  for (const MeanShift& shift :
       ScoreShifts(tape, own.Columns(), onsets).shifts) {
    if (shift.of_state || shift.group != DeviationColumns::kImu) continue;
    const ImuDeviation& one =
        ImuDeviations()[static_cast<std::size_t>(shift.column)];
    if (one.kind != ImuDeviation::Kind::kScale || !one.of_gyros) continue;
    out.z.push_back(shift.z());
    out.told.push_back(own.ZOf(shift));
  }
  return out;
}

/// What noise of the readings looks like is none, whichever way it goes.
TEST(DeviationColumns, NoiseOfReadingsIsNoScale) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    const ScaleScores right = ScalesOf(0.0, seed);
    const ScaleScores wrong = ScalesOf(0.1, seed);
    ASSERT_EQ(right.told.size(), 3u);
    EXPECT_GT(std::abs(right.z[0]), 3.0) << seed;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(right.told[axis]), 3.0) << seed << " " << axis;
      EXPECT_GT(wrong.told[axis], 30.0) << seed << " " << axis;
    }
  }
}

/// A sensor's by its own fixes, those of the IMU by the sensor that has the fewest.
TEST(LikelyDeviations, HaveNoLimitBelowTheLeast) {
  LikelyDeviation one = {.shift = {}, .z = -4.5, .limit = 4.2};
  const auto is_told = [&one](const std::vector<double>& least) {
    LikelyDeviations all(least);
    all.Offer(one);
    return !all.Sorted().empty();
  };
  EXPECT_TRUE(is_told({}));
  EXPECT_TRUE(is_told({0.0, 5.0}));
  EXPECT_FALSE(is_told({5.0, 0.0}));
  one.shift.group = DeviationColumns::kImu;
  EXPECT_TRUE(is_told({5.0, 0.0}));
  EXPECT_FALSE(is_told({5.0, 6.0}));
}

}  // namespace
}  // namespace hindsight::testing
