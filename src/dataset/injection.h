#ifndef HINDSIGHT_DATASET_INJECTION_H_
#define HINDSIGHT_DATASET_INJECTION_H_

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// Adds errors to position, velocity and height measurements and lists them in
/// the data set; of a height, up, whatever the axes. Within [from, to):
///   step       `size` (a pulse, if `to` is finite)
///   ramp       grows from zero at `from` to `size` at `to`, which must be
///              finite, and ends there
///   spikes     `size` with a sign drawn for each axis, on a random `share` of
///              the measurements
///   multipath  a Gauss-Markov error of standard deviation `size` and
///              correlation time `tau`, axes independent
/// Errors add up. They are drawn from the seed and the injection's number, so
/// that a later injection changes nothing of an earlier one. Throws InputError
/// for a sensor that is not there or of a type that has no such error, a ramp
/// without end, and a span without measurements.
void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, Dataset* dataset);

/// "position: step of 12 m north, east from 140 s to 150 s".
std::string Describe(const Injection& injection);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_INJECTION_H_
