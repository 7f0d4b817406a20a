#include "receiver_errors/bias_range.h"

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

ErrorParameters Typical() {
  ErrorParameters typical;
  typical.sigma = kFixSigma;
  typical.tau = 100.0;
  return typical;
}

ModeSequence Throughout() {
  ModeSequence biased(301, {.mode = ErrorMode::kBiased});
  biased.front().anew = true;
  return biased;
}

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
  const ModeSequence biased = Throughout();
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
  const ErrorParameters from = Typical();
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
  const ErrorParameters from = Typical();
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
  const ErrorParameters from = Typical();
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
  const ErrorParameters from = Typical();
  const Told told = TellOf(TapeWithErrors(kFixSigma / 50.0, 60.0,
                                          OfPositions(300.0, kFixSigma), 250.0),
                           from);
  const ErrorParameters& p = told.range.likeliest;
  EXPECT_LT(p.sigma, kFixSigma);
  EXPECT_GT(p.down * p.sigma, 2.0 * kFixSigma);
}

TEST(FollowBias, ExpectsTheVarianceOfTheMean) {
  const ErrorParameters from = Typical();
  const BiasRange range =
      TellOf(TapeWithErrors(5.0 * kFixSigma, 100.0), from).range;
  EXPECT_GT(VarianceOfMean(range.expected, 300.0),
            VarianceOfMean(range.mean, 300.0));
}

/// A density of ln x that is normal about ln of a typical x.
double LogNormal(double x, double typical, double spread) {
  const double z = std::log(x / typical) / spread;
  return std::exp(-0.5 * z * z) / (spread * std::sqrt(2.0 * std::numbers::pi));
}

/// Over a dense grid of sigma and tau: of every tau with what is likeliest of the IMU and
/// down, sought from its neighbour's on.
struct DenseIntegrals {
  double sum = 0.0;
  double variance = 0.0;  ///< of the mean of the bias, expected
  double slight_sum = 0.0;
  double slight_variance = 0.0;
};

constexpr double kSigmaStep = 0.2;  // of the logarithm
constexpr double kTauStep = 0.5;

void AddSlice(const ErrorParameters& at, const ErrorParameters& from,
              double best, const ParameterTuning& tuning, DenseIntegrals* all) {
  for (double i = -60.0; i <= 20.0; ++i) {
    ErrorParameters p = at;
    p.sigma = from.sigma * std::exp(kSigmaStep * i);
    p.down = std::clamp(at.down * at.sigma / p.sigma, 0.02, 50.0);
    const double weight =
        std::exp(tuning.Value(p) - best) * kSigmaStep * kTauStep;
    const double slight = weight * LogNormal(p.sigma, from.sigma, 1.0) *
                          LogNormal(p.tau, from.tau, 1.6) /
                          LogNormal(p.sigma, from.sigma, 2.3) /
                          LogNormal(p.tau, from.tau, 2.3);
    const double variance = VarianceOfMean(p, 300.0);
    all->sum += weight;
    all->variance += weight * variance;
    all->slight_sum += slight;
    all->slight_variance += slight * variance;
  }
}

DenseIntegrals IntegrateDensely(const ErrorParameters& likeliest,
                                const ErrorParameters& from, double best,
                                ParameterTuning* tuning) {
  DenseIntegrals all;
  AddSlice(likeliest, from, best, *tuning, &all);
  for (const double step : {kTauStep, -kTauStep}) {
    ErrorParameters at = likeliest;
    for (int j = 0; j < 20; ++j) {
      at.tau *= std::exp(step);
      at.sigma *= std::exp(0.5 * step);
      for (double ErrorParameters::*member :
           {&ErrorParameters::sigma, &ErrorParameters::down,
            &ErrorParameters::imu_scale}) {
        tuning->ClimbAlone(member, at);
        at = tuning->parameters();
      }
      AddSlice(at, from, best, *tuning, &all);
    }
  }
  all.variance /= all.sum;
  all.slight_variance /= all.slight_sum;
  return all;
}

/// What the noise hides is no ridge.
TEST(FollowBias, IntegratesOverSigmaAndTau) {
  const ErrorParameters from = Typical();
  const ModeSequence biased = Throughout();
  for (const double sigma : {0.0, 1.0 * kFixSigma, 5.0 * kFixSigma}) {
    const LinearTape linear = TapeWithErrors(sigma, 100.0);
    const SensorTape tape(linear, 0);
    const BiasRange range =
        FollowBias(tape, biased, TuneParameters(tape, biased, from), from);
    ParameterTuning tuning(tape, biased, from, nullptr);
    const double best = tuning.Value(range.likeliest);
    const DenseIntegrals grid =
        IntegrateDensely(range.likeliest, from, best, &tuning);
    // As if of each parameter by itself, with the gain; by the prior.
    const double share =
        tuning.LogShareOfPrior(&ErrorParameters::sigma, range.likeliest, best) +
        tuning.LogShareOfPrior(&ErrorParameters::tau, range.likeliest, best) +
        range.log_gain;
    const double prior = std::log(2.0 * std::numbers::pi * 2.3 * 2.3);
    constexpr double kLog = 0.25;
    EXPECT_NEAR(share, std::log(grid.sum) - prior, kLog) << sigma;
    EXPECT_NEAR(std::log(VarianceOfMean(range.expected, 300.0) / grid.variance),
                0.0, kLog)
        << sigma;
    ASSERT_TRUE(range.slight.has_value());
    EXPECT_NEAR(range.slight->log_gain, std::log(grid.slight_sum / grid.sum),
                kLog)
        << sigma;
    EXPECT_NEAR(std::log(VarianceOfMean(range.slight->expected, 300.0) /
                         grid.slight_variance),
                0.0, kLog)
        << sigma;
  }
}

/// Where the effort does not suffice to follow it, nothing is told of what it began with.
TEST(FollowBias, ThatWasNotFollowedLeavesNothingOpen) {
  const ErrorParameters from = Typical();
  const ModeSequence biased = Throughout();
  const LinearTape linear = TapeWithErrors(kFixSigma, 100.0);
  const SensorTape tape(linear, 0);
  SearchEffort effort(1.0, nullptr);
  EXPECT_FALSE(FollowBias(tape, biased, from, from, &effort).slight);
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
