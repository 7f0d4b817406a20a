#include <algorithm>
#include <cmath>

#include "measurements/sensor_kind.h"
#include "problems/error_search.h"

namespace hindsight {

double ErrorSearch::LogOfPrior() const {
  double log = LogOfCoincidences();
  for (const Round& round : rounds_) {
    const ReceiverErrors& one = round.best();
    if (one.Stands()) log += one.LogOfPrior();
  }
  return log;
}

double ErrorSearch::LogEvidence(const std::vector<State>& initial) const {
  Problem problem = problem_;
  const LinearTape tape = RunLinearizedFilter(states_ ? *states_ : initial,
                                              &problem, options_->callback);
  double log = LogOfPrior();
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (z.accepted && !z.withheld) log += z.log_likelihood;
    }
  }
  return log;
}

std::vector<double> ErrorSearch::ChangesOfPositions() const {
  std::vector<double> all;
  for (const Round& round : rounds_) {
    const ReceiverErrors& one = round.best();
    if (!one.Stands() || !KindOf(one).is_position) continue;
    const std::vector<double> times = one.ChangeTimes();
    all.insert(all.end(), times.begin(), times.end());
  }
  return all;
}

double ErrorSearch::LogOfCoincidences() const {
  constexpr double kTogether = 0.5;
  constexpr double kSameTime = 1.5;  // [s]
  std::vector<double> of_positions = ChangesOfPositions();
  double log = 0.0;
  for (const Round& round : rounds_) {
    const ReceiverErrors& one = round.best();
    if (!one.Stands() || !IsOfVelocity(KindOf(one))) continue;
    for (const double t : one.ChangeTimes()) {
      const auto together = std::ranges::find_if(of_positions, [t](double at) {
        return std::abs(at - t) < kSameTime;
      });
      if (together == of_positions.end()) continue;
      of_positions.erase(together);
      log += std::max(0.0, std::log(kTogether * one.searched_fixes()));
    }
  }
  return log;
}

}  // namespace hindsight
