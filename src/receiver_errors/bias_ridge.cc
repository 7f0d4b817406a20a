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

/// Of a bias, with the likeliest sigma of a tau.
struct RidgePoint {
  double tau = 0.0;
  double sigma = 0.0;
  double value = 0.0;  ///< ln of the posterior
};

ErrorParameters WithBias(ErrorParameters p, const RidgePoint& at) {
  p.tau = at.tau;
  p.sigma = at.sigma;
  return p;
}

RidgePoint PointAt(const ErrorParameters& p, ParameterTuning* tuning) {
  tuning->ClimbAlone(&ErrorParameters::sigma, p);
  return {.tau = tuning->parameters().tau,
          .sigma = tuning->parameters().sigma,
          .value = tuning->value()};
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
    const RidgePoint point = PointAt(p, tuning);
    if (point.value < best - kLeastGain) break;
    best = std::max(best, point.value);
    ridge.push_back(point);
    p = WithBias(p, point);
  }
  return ridge;
}

/// Between the points of a ridge of growing sigma and tau; at its ends beyond them.
RidgePoint OfSigma(const std::vector<RidgePoint>& falling, double sigma) {
  for (std::size_t i = 1; i < falling.size(); ++i) {
    const RidgePoint& above = falling[i - 1];
    const RidgePoint& below = falling[i];
    if (below.sigma > sigma || above.sigma <= below.sigma) continue;
    const double part =
        std::log(sigma / below.sigma) / std::log(above.sigma / below.sigma);
    return {.tau = below.tau * std::pow(above.tau / below.tau, part),
            .sigma = sigma};
  }
  return {.tau = falling.back().tau, .sigma = sigma};
}

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
  double sum = 0.0;
  double sum_logs = 0.0;
  for (const RidgePoint& one : ridge) {
    const double weight = std::exp(one.value - best.value);
    sum += weight;
    sum_logs += weight * std::log(one.sigma);
  }
  BiasRange range{
      .likeliest = WithBias(found, best),
      .mean = WithBias(found, OfSigma(ridge, std::exp(sum_logs / sum)))};
  const double prior =
      LogOfIntegral(PriorCurvature(tuning.TunableOf(&ErrorParameters::tau)));
  const double at_point = tuning.LogShareOfPrior(&ErrorParameters::tau,
                                                 range.likeliest, best.value);
  range.log_gain =
      std::max(0.0, std::log(sum * std::log(kRidgeStep)) - prior - at_point);
  return range;
}

}  // namespace hindsight
