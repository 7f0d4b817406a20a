#ifndef HINDSIGHT_EVALUATION_OUTAGES_H_
#define HINDSIGHT_EVALUATION_OUTAGES_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// RMS and largest length of the errors of a prediction [m, or m/s for a
/// velocity].
struct PredictionError {
  double horizontal_rms = 0.0;
  double horizontal_max = 0.0;
  double total_rms = 0.0;  ///< three-dimensional
  double total_max = 0.0;
};

/// A solution against the measurements withheld in one outage.
struct OutageError {
  Outage outage;
  const SensorKind* kind = &PositionKind();
  std::size_t count = 0;  ///< withheld measurements compared
  /// Absent if none was compared.
  std::optional<PredictionError> error;
  /// Path travelled over the Earth during the outage, the integral of the
  /// solution's speed [m].
  double distance = 0.0;
  /// Position outages only: largest horizontal error as a part of `distance`
  /// [%]. Absent if the vehicle hardly moved (below 1 m).
  std::optional<double> drift_percent;
};

/// Every outage of a sensor that measures a NED vector (position, velocity),
/// in the order of the data set. The error is that of the prediction against
/// the measurement, so it includes the measurement's own noise.
std::vector<OutageError> ComputeOutageErrors(const Solution& solution,
                                             const Dataset& dataset);

/// RMS and max over all withheld measurements of all outages of a kind, each
/// measurement with equal weight; absent if there are none.
std::optional<PredictionError> PoolOutageErrors(
    const std::vector<OutageError>& outages, const SensorKind& kind);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_OUTAGES_H_
