#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_REFINEMENT_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_REFINEMENT_H_

#include "receiver_errors/history_search.h"

namespace hindsight {

/// Climbs from the best of `found` over Variations, and WithOneJolt where those
/// do no better, to the most likely history near it. Scores are those of
/// HistorySplice about the best of the round before.
ErrorHistory ClimbHistories(const LinearTape& tape, int receiver,
                            const ErrorParameters& parameters,
                            const std::vector<ScoredHistory>& found);

/// Climbs, tries EarlierErrors of the best, and returns what was met on the way
/// and is within 10 of its logarithm, best first: the posterior of when errors
/// began and ended.
std::vector<ScoredHistory> RefineHistories(
    const LinearTape& tape, int receiver, const ErrorParameters& parameters,
    const std::vector<ScoredHistory>& found);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_REFINEMENT_H_
