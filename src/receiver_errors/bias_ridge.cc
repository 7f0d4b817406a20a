#include "receiver_errors/bias_ridge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "receiver_errors/regime_choice.h"

namespace hindsight {
namespace {

RidgePoint PointAt(const ErrorParameters& p, ParameterTuning* tuning) {
  tuning->ClimbAlone(&ErrorParameters::sigma, p);
  tuning->ClimbAlone(&ErrorParameters::down, tuning->parameters());
  tuning->ClimbAlone(&ErrorParameters::imu_scale, tuning->parameters());
  return {.parameters = tuning->parameters(), .value = tuning->value()};
}

/// The point with another tau, sought from its neighbour on.
RidgePoint PointBeside(const ErrorParameters& neighbour, double tau,
                       ParameterTuning* tuning) {
  ErrorParameters p = neighbour;
  p.sigma *= std::sqrt(tau / p.tau);
  p.tau = tau;
  return PointAt(p, tuning);
}

/// The points with a tau `step` times that of the one before, behind `from`, until odds
/// are a thousand against them.
std::vector<RidgePoint> PointsBehind(const RidgePoint& from, double step,
                                     ParameterTuning* tuning) {
  constexpr int kMost = 8;
  std::vector<RidgePoint> ridge;
  double best = from.value;
  ErrorParameters p = from.parameters;
  for (int i = 0; i < kMost && !tuning->IsSpent(); ++i) {
    RidgePoint point = PointBeside(p, step * p.tau, tuning);
    if (point.value < best - kLeastGain) break;
    best = std::max(best, point.value);
    p = point.parameters;
    ridge.push_back(std::move(point));
  }
  return ridge;
}

/// Beside the IMU's noise of one maximum of the posterior another may not be met: points
/// are sought from the best of a ridge on, as long as they gain, until it stays the best.
void ClimbFromBest(std::vector<RidgePoint>* ridge, ParameterTuning* tuning) {
  constexpr double kGains = 0.01;  // ln
  const auto seek = [&](std::size_t from, std::size_t to) {
    RidgePoint point = PointBeside((*ridge)[from].parameters,
                                   (*ridge)[to].parameters.tau, tuning);
    if (point.value <= (*ridge)[to].value + kGains) return false;
    (*ridge)[to] = std::move(point);
    return true;
  };
  std::size_t best = ridge->size();
  while (!tuning->IsSpent()) {
    const auto top = static_cast<std::size_t>(
        std::ranges::max_element(*ridge, {}, &RidgePoint::value) -
        ridge->begin());
    if (top == best) return;
    best = top;
    for (std::size_t i = best; i > 0 && seek(i, i - 1);) --i;
    for (std::size_t i = best; i + 1 < ridge->size() && seek(i, i + 1);) ++i;
  }
}

}  // namespace

std::vector<RidgePoint> FindRidge(const ErrorParameters& found,
                                  ParameterTuning* tuning) {
  const RidgePoint first = PointAt(found, tuning);
  std::vector<RidgePoint> ridge = PointsBehind(first, kRidgeStep, tuning);
  std::ranges::reverse(ridge);
  ridge.push_back(first);
  std::ranges::move(PointsBehind(first, 1.0 / kRidgeStep, tuning),
                    std::back_inserter(ridge));
  ClimbFromBest(&ridge, tuning);
  return ridge;
}

ErrorParameters PointAtTau(const std::vector<RidgePoint>& falling, double tau) {
  const auto below = std::ranges::find_if(
      falling,
      [tau](const RidgePoint& one) { return one.parameters.tau <= tau; });
  if (below == falling.begin()) return falling.front().parameters;
  if (below == falling.end()) return falling.back().parameters;
  ErrorParameters p = below->parameters;
  const ErrorParameters& above = std::prev(below)->parameters;
  const double part = std::log(tau / p.tau) / std::log(above.tau / p.tau);
  for (double ErrorParameters::*member :
       {&ErrorParameters::tau, &ErrorParameters::sigma, &ErrorParameters::down,
        &ErrorParameters::imu_scale}) {
    p.*member *= std::pow(above.*member / p.*member, part);
  }
  return p;
}

}  // namespace hindsight
