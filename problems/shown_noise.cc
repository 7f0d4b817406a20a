#include "problems/shown_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/chi_square.h"
#include "base/error.h"
#include "filters/forward_filter.h"
#include "problems/explanations.h"
#include "problems/judged_innovations.h"

namespace hindsight {
namespace {

/// By sensor.
using Factors = std::map<int, double>;

struct Spread {
  double squares = 0.0;
  double largest = 0.0;
  double count = 0.0;

  /// Of independent normal variables the root mean square; more where one of
  /// them is larger than any of so many is with that probability.
  double Sigma(double tail) const {
    return std::max(
        std::sqrt(squares / count),
        largest / std::sqrt(ChiSquareQuantile(1.0 - tail / count, 1.0)));
  }
};

/// What the innovations of sensors that state too much say their sigmas are, in
/// those.
Factors Overstated(const std::vector<NormalisedInnovation>& innovations,
                   double false_alarms) {
  std::map<int, Spread> spreads;
  for (const NormalisedInnovation& one : innovations) {
    Spread& own = spreads[one.sensor];
    own.squares += one.white.squaredNorm();
    own.largest = std::max(own.largest, one.white.cwiseAbs().maxCoeff());
    own.count += static_cast<double>(one.white.size());
  }
  Factors factors;
  const double tail = false_alarms / static_cast<double>(spreads.size());
  for (const auto& [sensor, own] : spreads) {
    const double sigma = own.Sigma(tail);
    if (sigma > 0.0 && sigma * kDoubtfulError < 1.0 &&
        ChiSquareCdf(own.squares, own.count) < tail) {
      factors[sensor] = sigma;
    }
  }
  return factors;
}

}  // namespace

bool StateTooMuch(const std::vector<NormalisedInnovation>& innovations,
                  double false_alarms) {
  return !Overstated(innovations, false_alarms).empty();
}

std::vector<Explanation> ExplainByShownNoise(
    const Dataset& dataset, const Relinearised& solution,
    const std::vector<NormalisedInnovation>& innovations, double false_alarms,
    const Problem& problem, const EpochCallback& callback) {
  // What other noise makes of the innovations keeps them below one where it is
  // overstated too.
  constexpr int kMostSteps = 4;
  Factors factors = Overstated(innovations, false_alarms);
  if (factors.empty()) return {};
  Problem scaled = problem;
  try {
    for (int step = 1;; ++step) {
      for (const auto& [sensor, factor] : factors) {
        scaled.timeline.ScaleSensor(sensor, factor);
      }
      const LinearTape tape =
          RunLinearizedFilter(solution.states, &scaled, callback);
      const std::vector<NormalisedInnovation> now =
          InnovationsOf(tape, scaled.timeline, dataset);
      factors = Overstated(now, false_alarms);
      if (!factors.empty() && step < kMostSteps) continue;
      const double excess =
          std::max(1.0, LargestExcess(TestInnovations(now, false_alarms)));
      std::vector<Explanation> found =
          ExplanationSearch(scaled, solution.states, tape, false_alarms,
                            callback)
              .Tell(solution, EffectOn::kNavigation);
      for (Explanation& one : found) {
        one.z /= excess;
        one.shift_that_matters = kDoubtfulError;
        one.what += ", if sigmas were what the innovations say";
      }
      return found;
    }
  } catch (const EstimationError&) {
    // With so little noise no filter holds about the states.
    return {};
  }
}

}  // namespace hindsight
