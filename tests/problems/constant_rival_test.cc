#include "problems/constant_rival.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>

#include "filters/forward_filter.h"
#include "problems/robust_batch.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// A minute with fixes, by gyros of which one reads `scale` times the truth.
TestProblem Minute(double scale) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 60.0;
  options.position_sigma = 0.01;
  TestProblem test = MakeProblem(options, 3);
  for (ImuSample& sample : test.imu.samples) sample.gyro.z() *= scale;
  return test;
}

std::optional<ConstantRival> LikeliestOf(const TestProblem& test) {
  return LikeliestConstant(
      test.Pose(GateDecisions(test.measurements.size(), 1)), test.truth);
}

TEST(ConstantRival, OfARightModelIsWorthLessThanOddsOfAThousand) {
  const std::optional<ConstantRival> rival = LikeliestOf(Minute(1.0));
  ASSERT_TRUE(rival);
  EXPECT_LT(rival->log_gain, 0.0);
}

TEST(ConstantRival, IsTheScaleOfAGyroThatReadsTooMuch) {
  const std::optional<ConstantRival> rival = LikeliestOf(Minute(1.01));
  ASSERT_TRUE(rival);
  EXPECT_TRUE(rival->what.starts_with("gyro z measures") &&
              rival->what.ends_with("too much"))
      << rival->what;
  EXPECT_GT(rival->log_gain, 20.0);
}

/// By all measurements, whose likelihood about the truth is larger by as much if the
/// readings are put right: its half square of z is the gain at the likeliest size.
TEST(ConstantRival, GainsWhatPuttingItRightGains) {
  const auto log_likelihood = [](const TestProblem& test) {
    Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
    const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
    double sum = 0.0;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      for (const TapeMeasurement& z : tape.measurements(k)) {
        sum += z.log_likelihood;
      }
    }
    return sum;
  };
  const TestProblem scaled = Minute(1.01);
  const double gain = log_likelihood(Minute(1.0)) - log_likelihood(scaled);
  const std::optional<ConstantRival> rival = LikeliestOf(scaled);
  ASSERT_TRUE(rival);
  // The likeliest size explains the noise as well.
  EXPECT_NEAR(rival->log_gain + kSureLogOdds, gain, 0.05 * gain);
}

}  // namespace
}  // namespace hindsight
