#ifndef HINDSIGHT_FILTERS_HISTORY_REFINEMENT_H_
#define HINDSIGHT_FILTERS_HISTORY_REFINEMENT_H_

#include "filters/history_search.h"

namespace hindsight {

/// Climbs from the best of `found` to the most likely history near it - changes
/// moved by up to eight fixes, left out, of another kind, with a bias before
/// them, or taken for jolts of the IMU - and returns what was met on the way
/// and is within 10 of its logarithm, best first: the posterior of when errors
/// began and ended. Of biases before a larger error lengths a
/// quarter apart are tried, each of which stands for those up to the next.
std::vector<ScoredHistory> RefineHistories(
    const LinearTape& tape, int receiver, const ErrorParameters& parameters,
    const std::vector<ScoredHistory>& found);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_HISTORY_REFINEMENT_H_
