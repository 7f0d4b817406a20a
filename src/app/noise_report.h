#ifndef HINDSIGHT_APP_NOISE_REPORT_H_
#define HINDSIGHT_APP_NOISE_REPORT_H_

#include <string>

#include "problems/noise_estimation.h"

namespace hindsight {

/// The factors with their bounds, and what the data do not see.
std::string DescribeNoise(const NoiseEstimate& estimate);

/// Puts into the configuration what the data tell to differ from what it says by
/// more than two standard deviations, and says what was written and what has no
/// place there. Throws InputError, OutputError.
std::string WriteNoise(const NoiseEstimate& estimate, const Dataset& dataset,
                       const std::string& config);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_NOISE_REPORT_H_
