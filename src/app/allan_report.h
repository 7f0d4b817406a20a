#ifndef HINDSIGHT_APP_ALLAN_REPORT_H_
#define HINDSIGHT_APP_ALLAN_REPORT_H_

#include <optional>
#include <string>

#include "dataset/allan.h"
#include "dataset/dataset.h"
#include "dataset/rest.h"

namespace hindsight {

/// Of the longest span at rest, or that may be; nothing if it holds fewer than
/// 1000 samples.
std::optional<ImuAllan> AllanOfLongestRest(const Dataset& dataset,
                                           const Rest& rest);

/// Allan deviations over the longest rest: a table of the deviation of each axis
/// against cluster time, one of the coefficients with their standard deviations,
/// and the `noise` block that follows from them. Throws EstimationError if no
/// rest holds 1000 samples.
std::string DescribeAllan(const Dataset& dataset, const Rest& rest);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_ALLAN_REPORT_H_
