#ifndef HINDSIGHT_PROBLEMS_CONTRADICTIONS_H_
#define HINDSIGHT_PROBLEMS_CONTRADICTIONS_H_

#include <string>
#include <vector>

#include "filters/forward_filter.h"
#include "measurements/sensor.h"
#include "state/solution.h"

namespace hindsight {

/// Where a solution and what it was told cannot both be right, in words: a
/// component of its first state more than five a priori sigmas from the prior
/// (a wrong sign, unit or clock, or a sigma that is too small), and a sensor
/// that lost more than half of its measurements to its gate. The verdict has
/// rules of its own.
std::vector<std::string> FindContradictions(const std::vector<Sensor>& sensors,
                                            const Prior& prior,
                                            const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CONTRADICTIONS_H_
