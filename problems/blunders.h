#ifndef HINDSIGHT_PROBLEMS_BLUNDERS_H_
#define HINDSIGHT_PROBLEMS_BLUNDERS_H_

#include <cstddef>
#include <vector>

#include "timeline/timeline.h"

namespace hindsight {

/// Faster than what leaves the Earth [m/s].
inline constexpr double kImpossibleSpeed = 1.2e4;

/// Positions that no vehicle reaches, as of a row with a latitude of 90 deg:
/// those farther from the last possible one of their sensor, or coming from the
/// end from the next, than kImpossibleSpeed covers meanwhile, beside 1 km that
/// any receiver may err by. Taken from the side that leaves more; none where
/// both refuse more than half. Indices of Timeline::all_measurements, in order.
/// They say nothing, not even to a robust loss, whose linearisation they ruin.
std::vector<std::size_t> FindBlunders(const Timeline& timeline);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_BLUNDERS_H_
