#include "receiver_errors/bias_range.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "receiver_errors/bias_ridge.h"
#include "receiver_errors/regime_choice.h"

namespace hindsight {
namespace {

/// The posterior at a sigma of a tau.
struct Sample {
  double log_sigma = 0.0;
  double value = 0.0;  ///< ln of it
};

/// Samples beside a point of the ridge, of sigmas larger (`sign` 1) or smaller (-1), until
/// the posterior is `least`. What errs down stays as it is.
std::vector<Sample> Beside(const RidgePoint& at, double sign, double least,
                           const ParameterTuning& tuning) {
  constexpr double kStep = 0.35;  // of ln sigma
  constexpr double kWidest = 4.0 * kStep;
  constexpr double kNarrowest = 0.01 * kStep;
  constexpr double kSteep = 2.0;
  constexpr double kFlat = 0.5;
  constexpr int kMost = 32;
  const Tunable& sigma = tuning.TunableOf(&ErrorParameters::sigma);
  const Tunable& down = tuning.TunableOf(&ErrorParameters::down);
  std::vector<Sample> samples;
  double step = kStep;
  double u = 0.0;
  double before = at.value;
  for (int i = 0; i < kMost && !tuning.IsSpent(); ++i) {
    ErrorParameters p = at.parameters;
    p.sigma *= std::exp(sign * (u + step));
    if (p.sigma < sigma.least || p.sigma > sigma.most) break;
    p.down = std::clamp(p.down * at.parameters.sigma / p.sigma, down.least,
                        down.most);
    const double value = tuning.Value(p);
    const double fall = before - value;
    if (fall > kSteep && step > kNarrowest) {
      step /= 3.0;
      continue;
    }
    if (value < least) break;
    samples.push_back({.log_sigma = std::log(p.sigma), .value = value});
    u += step;
    before = value;
    if (fall < kFlat) step = std::min(2.0 * step, kWidest);
  }
  return samples;
}

/// By ascending sigma.
std::vector<Sample> Across(const RidgePoint& at, double least,
                           const ParameterTuning& tuning) {
  std::vector<Sample> samples = Beside(at, -1.0, least, tuning);
  std::ranges::reverse(samples);
  samples.push_back(
      {.log_sigma = std::log(at.parameters.sigma), .value = at.value});
  std::ranges::move(Beside(at, 1.0, least, tuning),
                    std::back_inserter(samples));
  return samples;
}

/// What a sample stands for in ln sigma, by the trapezoid rule; of a single one a step
/// that is as good as any.
double WidthOf(const std::vector<Sample>& samples, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i;
  const std::size_t after = i + 1 < samples.size() ? i + 1 : i;
  constexpr double kSingle = 1e-3;
  if (before == after) return kSingle;
  return 0.5 * (samples[after].log_sigma - samples[before].log_sigma);
}

/// Integrals over ln sigma and ln tau of the posterior, by its greatest value on the
/// ridge.
struct Integrals {
  void Add(double weight, const ErrorParameters& p, double duration) {
    const double of_mean = weight * VarianceOfMean(p, duration);
    one += weight;
    log_sigma += weight * std::log(p.sigma);
    log_tau += weight * std::log(p.tau);
    variance += of_mean;
    variance_log_tau += of_mean * std::log(p.tau);
  }

  double one = 0.0;
  double log_sigma = 0.0;
  double log_tau = 0.0;
  double variance = 0.0;          ///< of the mean
  double variance_log_tau = 0.0;  ///< of their product
};

/// By the prior of a bias, and by that of a slight one.
struct BothIntegrals {
  Integrals biased;
  Integrals slight;
};

/// The density a priori of ln of a parameter with another spread by that with its own.
double DensityRatio(const Tunable& own, double spread, double value) {
  const double z = std::log(value / own.typical);
  const double curvature = 1.0 / (spread * spread);
  return std::exp(LogOfIntegral(PriorCurvature(own)) -
                  LogOfIntegral(curvature) -
                  0.5 * (curvature - PriorCurvature(own)) * z * z);
}

BothIntegrals Integrate(const std::vector<RidgePoint>& ridge, double best,
                        double duration, const ParameterTuning& tuning) {
  const Tunable& sigma = tuning.TunableOf(&ErrorParameters::sigma);
  const Tunable& tau = tuning.TunableOf(&ErrorParameters::tau);
  BothIntegrals sums;
  for (const RidgePoint& at : ridge) {
    const std::vector<Sample> samples = Across(at, best - kLeastGain, tuning);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double weight = std::exp(samples[i].value - best) *
                            WidthOf(samples, i) * std::log(kRidgeStep);
      ErrorParameters p = at.parameters;
      p.sigma = std::exp(samples[i].log_sigma);
      sums.biased.Add(weight, p, duration);
      const double slight = DensityRatio(sigma, kSpreadOfSlight, p.sigma) *
                            DensityRatio(tau, kSpreadOfSlightTau, p.tau);
      sums.slight.Add(weight * slight, p, duration);
    }
  }
  return sums;
}

/// BiasRange::expected.
ErrorParameters ExpectedOf(const Integrals& sum,
                           const std::vector<RidgePoint>& ridge,
                           double duration) {
  ErrorParameters p =
      PointAtTau(ridge, std::exp(sum.variance_log_tau / sum.variance));
  p.sigma *= std::sqrt(sum.variance / sum.one / VarianceOfMean(p, duration));
  return p;
}

}  // namespace

BiasRange FollowBias(const SensorTape& tape, const ModeSequence& sequence,
                     const ErrorParameters& found, const ErrorParameters& from,
                     SearchEffort* effort) {
  ParameterTuning tuning(tape, sequence, from, effort);
  const std::vector<RidgePoint> ridge = FindRidge(found, &tuning);
  const RidgePoint& best =
      *std::ranges::max_element(ridge, {}, &RidgePoint::value);
  const double duration = tape.t(tape.size() - 1) - tape.t(0);
  const auto [sum, slight] = Integrate(ridge, best.value, duration, tuning);
  BiasRange range;
  range.likeliest = best.parameters;
  range.mean = PointAtTau(ridge, std::exp(sum.log_tau / sum.one));
  range.mean.sigma = std::exp(sum.log_sigma / sum.one);
  range.expected = ExpectedOf(sum, ridge, duration);
  if (!tuning.IsSpent()) {
    range.slight = SlightBias{.expected = ExpectedOf(slight, ridge, duration),
                              .log_gain = std::log(slight.one / sum.one)};
  }
  range.log_gain = std::log(sum.one);
  for (double ErrorParameters::*member :
       {&ErrorParameters::tau, &ErrorParameters::sigma}) {
    const Tunable& tunable = tuning.TunableOf(member);
    range.log_gain -=
        LogOfIntegral(PriorCurvature(tunable)) + LogOfPriorWithin(tunable) +
        tuning.LogShareOfPrior(member, range.likeliest, best.value);
  }
  // What was not followed to its end is larger.
  if (tuning.IsSpent()) range.log_gain = std::max(0.0, range.log_gain);
  return range;
}

double VarianceOfMean(const ErrorParameters& p, double duration) {
  const double x = duration / p.tau;
  // 1 - (1 - exp(-x)) / x, of a short one without its cancellation.
  constexpr double kShort = 1e-4;
  const double rest = x < kShort ? 0.5 * x : 1.0 + std::expm1(-x) / x;
  return 2.0 * p.sigma * p.sigma / x * rest;
}

}  // namespace hindsight
