#ifndef HINDSIGHT_DATASET_INJECTION_H_
#define HINDSIGHT_DATASET_INJECTION_H_

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/time_interval.h"

namespace hindsight {

/// What is wrong with the span of an injection, and what was expected; "" if
/// nothing is.
std::string SpanObjection(const Injection& injection);

/// Adds errors to position, velocity and height measurements and lists them in
/// the data set; of a height, up. Within [from, to) of the stamps:
///   step       `size`
///   pulse      `size`; `to` must be finite
///   ramp       grows from zero at `from` to `size` at `to`, which must be
///              finite, and ends there
///   spikes     `size` with a sign drawn for each axis, on a random `share` of
///              the measurements
///   multipath  a Gauss-Markov error of standard deviation `size` and
///              correlation time `tau`, axes independent
/// Errors add up. They are drawn from the seed, the injection's number and, of
/// several streams that it fits, the stream's, so that a later injection
/// changes nothing of an earlier one and no two streams have the same errors.
/// Withheld measurements, which judge the estimators, stay as they are. `used`
/// is the part of the recording that is reconstructed, in the IMU's clock;
/// measurements outside are not counted. Throws InputError for a sensor that is
/// not there or of a type that has no such error, a size in another unit than
/// the sensor's, axes of a height, a pulse or ramp without end, and a span that
/// holds no measurement that is used.
void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, const TimeInterval& used,
                     Dataset* dataset);
/// The same, of a recording that is used from end to end.
void ApplyInjections(const std::vector<Injection>& injections,
                     std::uint64_t seed, Dataset* dataset);

/// "position: step of 12 m north, east from 140 s to 150 s".
std::string Describe(const Injection& injection);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_INJECTION_H_
