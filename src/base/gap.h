#ifndef HINDSIGHT_BASE_GAP_H_
#define HINDSIGHT_BASE_GAP_H_

#include <vector>

namespace hindsight {

/// The longest time between two measurements of a sensor that is no gap: five times
/// the median of `spacings`, the times between neighbours [s]. 0 of none.
double LongestSpacingWithoutGap(const std::vector<double>& spacings);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_GAP_H_
