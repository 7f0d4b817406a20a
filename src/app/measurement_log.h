#ifndef HINDSIGHT_APP_MEASUREMENT_LOG_H_
#define HINDSIGHT_APP_MEASUREMENT_LOG_H_

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// Logs, as information, every measurement that a method rejected or gave less
/// than half of its weight: time [s], sensor, residual and sigma by component
/// (SI units), weight.
void LogDownWeighted(const Dataset& dataset, const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_MEASUREMENT_LOG_H_
