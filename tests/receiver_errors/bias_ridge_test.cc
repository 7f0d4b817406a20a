#include "receiver_errors/bias_ridge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "receiver_errors/error_tuning.h"
#include "receiver_errors/parameter_tuning.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_smoother.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::OfPositions;
using testing::TapeOf;
using testing::TestProblem;
using testing::TestProblemOptions;

constexpr double kFixSigma = 2.0;  // [m]

/// Fixes with Gauss-Markov errors from the first to the last, so many times as large
/// down, beside an IMU whose noise may be stated otherwise than it is.
LinearTape TapeWithErrors(
    double sigma, double tau,
    const TestProblemOptions& stated = OfPositions(300.0, kFixSigma),
    double down = 1.0) {
  TestProblem problem = MakeProblem(OfPositions(300.0, kFixSigma), 7);
  problem.imu.noise = stated.noise;
  Random random(19);
  Eigen::Vector3d e = sigma * random.NormalVector3();
  const double a = std::exp(-1.0 / tau);
  for (Measurement& z : problem.measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    e = a * e + sigma * std::sqrt(1.0 - a * a) * random.NormalVector3();
    fix.p_e +=
        NedAxes(fix.p_e) * (Eigen::Vector3d(1.0, 1.0, down).cwiseProduct(e) +
                            kFixSigma * random.NormalVector3());
  }
  return TapeOf(problem);
}

/// What a tape tells of a bias throughout.
struct Told {
  BiasRange range;
  double log_odds = 0.0;  ///< of the likeliest against what was found
};

Told TellOf(const LinearTape& tape, const ErrorParameters& from) {
  ModeSequence biased(301, {.mode = ErrorMode::kBiased});
  biased.front().anew = true;
  const ErrorParameters found = TuneParameters({tape, 0}, biased, from);
  Told told{.range = FollowBias({tape, 0}, biased, found, from)};
  const auto posterior = [&](const ErrorParameters& p) {
    return ScoreSequence({tape, 0}, p, biased).log_likelihood +
           LogPriorOf(biased, p, from);
  };
  told.log_odds = posterior(told.range.likeliest) - posterior(found);
  return told;
}

TEST(FollowBias, GoesAsFarAsTheDataLeaveOpen) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  // The IMU tells all of an error that changes within seconds.
  const Told fast = TellOf(TapeWithErrors(5.0 * kFixSigma, 3.0), from);
  EXPECT_GE(fast.log_odds, 0.0);
  EXPECT_NEAR(fast.range.likeliest.tau, 3.0, 2.0);
  EXPECT_LT(fast.range.mean.sigma, 1.3 * fast.range.likeliest.sigma);
  // Of one of minutes but the walk.
  const Told slow = TellOf(TapeWithErrors(5.0 * kFixSigma, 300.0), from);
  EXPECT_GE(slow.log_odds, 0.0);
  EXPECT_GT(slow.range.log_gain, 0.0);
  EXPECT_NEAR(std::log(slow.range.mean.sigma / (5.0 * kFixSigma)), 0.0,
              std::log(2.0));
  const auto walk = [](const ErrorParameters& p) {
    return p.sigma * p.sigma / p.tau;
  };
  EXPECT_NEAR(std::log(walk(slow.range.mean) / walk(slow.range.likeliest)), 0.0,
              std::log(2.0));
}

/// The IMU is ten times better than stated: at the noise as stated what is slow would be
/// its own, and the error one of seconds.
TEST(FollowBias, TakesFromTheImuWhatTheSensorErrsBy) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  TestProblemOptions options = OfPositions(300.0, kFixSigma);
  options.noise.accel_noise_density *= 10.0;
  options.noise.gyro_noise_density *= 10.0;
  const Told told =
      TellOf(TapeWithErrors(5.0 * kFixSigma, 300.0, options), from);
  EXPECT_LT(told.range.likeliest.imu_scale, 0.5);
  EXPECT_GT(told.range.expected.sigma, 2.0 * kFixSigma);
}

/// Satellites are above: errors may be sideways alone. What says that there are none
/// down is not to say that there are none of minutes.
TEST(FollowBias, LeavesAnErrorSidewaysItsTime) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  const LinearTape tape = TapeWithErrors(5.0 * kFixSigma, 300.0,
                                         OfPositions(300.0, kFixSigma), 0.0);
  const Told told = TellOf(tape, from);
  // Beneath the noise.
  EXPECT_LT(told.range.likeliest.down * told.range.likeliest.sigma, kFixSigma);
  EXPECT_GT(told.range.expected.sigma, 2.0 * kFixSigma);
  EXPECT_GT(told.range.expected.tau, 60.0);
}

/// Nor does what errs down alone err sideways.
TEST(FollowBias, LeavesTheOtherAxesToAnErrorDown) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  const Told told = TellOf(TapeWithErrors(kFixSigma / 50.0, 60.0,
                                          OfPositions(300.0, kFixSigma), 250.0),
                           from);
  const ErrorParameters& p = told.range.likeliest;
  EXPECT_LT(p.sigma, kFixSigma);
  EXPECT_GT(p.down * p.sigma, 2.0 * kFixSigma);
}

TEST(FollowBias, ExpectsTheVarianceOfTheMean) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  const BiasRange range =
      TellOf(TapeWithErrors(5.0 * kFixSigma, 100.0), from).range;
  EXPECT_GT(VarianceOfMean(range.expected, 300.0),
            VarianceOfMean(range.mean, 300.0));
}

/// What the noise hides is no ridge. Integrals over sigma and tau are those of a grid, which
/// holds what the ridge has of the IMU and down as it is at its top.
TEST(FollowBias, IntegratesOverSigmaAndTau) {
  constexpr double kStep = 0.25;  // of ln sigma
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  ModeSequence biased(301, {.mode = ErrorMode::kBiased});
  biased.front().anew = true;
  for (const double sigma : {0.0, 1.0 * kFixSigma, 5.0 * kFixSigma}) {
    const LinearTape linear = TapeWithErrors(sigma, 100.0);
    const SensorTape tape(linear, 0);
    const ErrorParameters found = TuneParameters(tape, biased, from);
    const BiasRange range = FollowBias(tape, biased, found, from);
    const auto posterior = [&](const ErrorParameters& p) {
      return ScoreSequence(tape, p, biased).log_likelihood +
             LogPriorOf(biased, p, from);
    };
    const double best = posterior(range.likeliest);
    double sum = 0.0;
    double variances = 0.0;
    for (double i = -48.0; i <= 12.0; ++i) {
      for (double j = -10.0; j <= 10.0; ++j) {
        ErrorParameters p = range.likeliest;
        p.sigma = kFixSigma * std::exp(kStep * i);
        p.down = range.likeliest.down * range.likeliest.sigma / p.sigma;
        p.down = std::clamp(p.down, 0.02, 50.0);
        p.tau = 100.0 * std::exp(4.0 * kStep * j);
        const double weight = std::exp(posterior(p) - best);
        sum += weight;
        variances += weight * VarianceOfMean(p, 300.0);
      }
    }
    // ln of the integral of the posterior by that of the prior, whose spread is 2.3.
    const double log_share = std::log(sum * kStep * 4.0 * kStep /
                                      (2.0 * std::numbers::pi * 2.3 * 2.3));
    // What is made of each parameter by itself, with the gain, at those of the others.
    const double each = LogShareOfPrior(tape, biased, range.likeliest, from);
    ParameterTuning tuning(tape, biased, from, nullptr);
    const double others =
        each -
        tuning.LogShareOfPrior(&ErrorParameters::sigma, range.likeliest, best) -
        tuning.LogShareOfPrior(&ErrorParameters::tau, range.likeliest, best);
    EXPECT_NEAR(each - others + range.log_gain, log_share, 0.5) << sigma;
    EXPECT_NEAR(
        std::log(VarianceOfMean(range.expected, 300.0) / (variances / sum)),
        0.0, std::log(2.0))
        << sigma;
  }
}

/// As the double sum of its covariance over the duration.
TEST(VarianceOfMean, IsThatOfSamples) {
  constexpr double kDuration = 50.0;
  constexpr int kSamples = 2000;
  for (const double tau : {0.5, 10.0, 300.0}) {
    ErrorParameters p;
    p.sigma = 3.0;
    p.tau = tau;
    double sum = 0.0;
    for (int lag = 0; lag < kSamples; ++lag) {
      const double pairs = lag == 0 ? kSamples : 2.0 * (kSamples - lag);
      sum += pairs * std::exp(-lag * kDuration / kSamples / tau);
    }
    const double variance = 9.0 * sum / kSamples / kSamples;
    EXPECT_NEAR(VarianceOfMean(p, kDuration), variance, 2e-3 * variance) << tau;
  }
  ErrorParameters constant;
  constant.sigma = 3.0;
  constant.tau = 1e9;
  EXPECT_NEAR(VarianceOfMean(constant, kDuration), 9.0, 1e-6);
}

}  // namespace
}  // namespace hindsight
