#ifndef HINDSIGHT_EVALUATION_REFUSALS_H_
#define HINDSIGHT_EVALUATION_REFUSALS_H_

#include <optional>
#include <span>

#include "measurements/sensor.h"
#include "state/solution.h"

namespace hindsight {

/// What a solution left of a sensor's measurements, if that is too little to
/// believe it: not usable. Withheld measurements and Solution::left_out do not count.
///   - More than half of a sensor's measurements refused by its gate.
///   - More than ten in a row, over more than 10 s, refused by a gate or left
///     less than a tenth of their weight by a robust loss. That a
///     gate that passes 99.9 % does so by chance has a probability of 1e-33;
///     either the sensor erred or the solution does. It is held for the sensor
///     if the contradiction vanished - the first measurement accepted again has
///     less than a quarter of the mean normalised square of the last ten
///     refused ones, where a lost filter lets in what only its own growing P
///     has made likely - or if another sensor of position was accepted
///     meanwhile.
///   - Less than a tenth of its weight left by a robust loss to each of more
///     than half of a sensor's measurements. Weights of methods with modes say
///     how well a mode explains a measurement, and do not count.
std::optional<Evidence> FindRefusal(std::span<const Sensor> sensors,
                                    const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_REFUSALS_H_
