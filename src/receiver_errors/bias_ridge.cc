#include "receiver_errors/bias_ridge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "receiver_errors/parameter_tuning.h"
#include "receiver_errors/regime_choice.h"

namespace hindsight {
namespace {

constexpr double kRidgeStep = 2.0;  // of tau

/// Of a bias, with the likeliest sigma, sigma down and factor on the noise of the IMU of a
/// tau.
struct RidgePoint {
  ErrorParameters parameters;
  double value = 0.0;  ///< ln of the posterior
};

RidgePoint PointAt(const ErrorParameters& p, ParameterTuning* tuning) {
  tuning->ClimbAlone(&ErrorParameters::sigma, p);
  tuning->ClimbAlone(&ErrorParameters::down, tuning->parameters());
  tuning->ClimbAlone(&ErrorParameters::imu_scale, tuning->parameters());
  return {.parameters = tuning->parameters(), .value = tuning->value()};
}

/// The points with a tau `step` times that of the one before, `found` the first.
std::vector<RidgePoint> PointsFrom(const ErrorParameters& found, double step,
                                   ParameterTuning* tuning) {
  constexpr int kMost = 12;
  std::vector<RidgePoint> ridge;
  double best = tuning->Value(found);
  ErrorParameters p = found;
  for (int i = 0; i < kMost; ++i) {
    if (tuning->IsSpent()) break;
    p.tau *= step;
    p.sigma *= std::sqrt(step);
    RidgePoint point = PointAt(p, tuning);
    if (point.value < best - kLeastGain) break;
    best = std::max(best, point.value);
    p = point.parameters;
    ridge.push_back(std::move(point));
  }
  return ridge;
}

/// Between the points of a ridge of falling tau where `measure` of the parameters, which
/// falls with it, is `wanted`; at its ends beyond them.
template <typename Measure>
ErrorParameters PointWhere(const std::vector<RidgePoint>& falling,
                           const Measure& measure, double wanted) {
  for (std::size_t i = 1; i < falling.size(); ++i) {
    const ErrorParameters& above = falling[i - 1].parameters;
    ErrorParameters p = falling[i].parameters;
    const double most = measure(above);
    const double least = measure(p);
    if (least > wanted || most <= least) continue;
    const double part = std::log(wanted / least) / std::log(most / least);
    for (double ErrorParameters::*member :
         {&ErrorParameters::tau, &ErrorParameters::sigma,
          &ErrorParameters::down, &ErrorParameters::imu_scale}) {
      p.*member *= std::pow(above.*member / p.*member, part);
    }
    return p;
  }
  return falling.back().parameters;
}

double SigmaOf(const ErrorParameters& p) { return p.sigma; }

}  // namespace

BiasRange FollowBias(const SensorTape& tape, const ModeSequence& sequence,
                     const ErrorParameters& found, const ErrorParameters& from,
                     SearchEffort* effort) {
  ParameterTuning tuning(tape, sequence, from, effort);
  std::vector<RidgePoint> ridge = PointsFrom(found, kRidgeStep, &tuning);
  std::ranges::reverse(ridge);
  ridge.push_back(PointAt(found, &tuning));
  std::ranges::move(PointsFrom(found, 1.0 / kRidgeStep, &tuning),
                    std::back_inserter(ridge));
  const RidgePoint& best =
      *std::ranges::max_element(ridge, {}, &RidgePoint::value);
  const double duration = tape.t(tape.size() - 1) - tape.t(0);
  const auto variance = [duration](const ErrorParameters& p) {
    return VarianceOfMean(p, duration);
  };
  double sum = 0.0;
  double sum_logs = 0.0;
  double sum_variances = 0.0;
  for (const RidgePoint& one : ridge) {
    const double weight = std::exp(one.value - best.value);
    sum += weight;
    sum_logs += weight * std::log(one.parameters.sigma);
    sum_variances += weight * variance(one.parameters);
  }
  BiasRange range{.likeliest = best.parameters,
                  .mean = PointWhere(ridge, SigmaOf, std::exp(sum_logs / sum)),
                  .expected = PointWhere(ridge, variance, sum_variances / sum)};
  const double prior =
      LogOfIntegral(PriorCurvature(tuning.TunableOf(&ErrorParameters::tau)));
  const double at_point = tuning.LogShareOfPrior(&ErrorParameters::tau,
                                                 range.likeliest, best.value);
  range.log_gain =
      std::max(0.0, std::log(sum * std::log(kRidgeStep)) - prior - at_point);
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
