#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_REFINEMENT_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_REFINEMENT_H_

#include "receiver_errors/hypothesis_search.h"

namespace hindsight {

/// Steps of all sequences that are kept together: 40 MB. Of a long recording nearly
/// as many are alike as it has fixes.
inline constexpr std::size_t kMostKeptSteps = 10'000'000;

/// Climbs from the best of `found` over Variations, ForEachVelocityStep where those
/// do no better, and outliers where neither does, to the most likely sequence near it. Scores are those of
/// SequenceSplice about the best of the round before. A spent effort ends it with
/// the best so far.
ModeSequence ClimbSequences(const SensorTape& tape,
                            const ErrorParameters& parameters,
                            const std::vector<Hypothesis>& found,
                            SearchEffort* effort = nullptr);

/// Climbs over which fixes are outliers by decision alone: of those that may be by
/// what is known before them (SequenceSplice::MayBeAnOutlier), or that are.
ModeSequence ClimbOutliers(const SensorTape& tape,
                           const ErrorParameters& parameters,
                           const ModeSequence& sequence,
                           SearchEffort* effort = nullptr);

/// Climbs, also over HiddenChanges of the best with outliers of their own, tries
/// ForEachEarlierError of it, and returns what was met on the way
/// and is within 10 of its logarithm, best first: the posterior of when errors
/// began and ended. Of those that differ in outliers alone the likeliest.
std::vector<Hypothesis> RefineHypotheses(const SensorTape& tape,
                                         const ErrorParameters& parameters,
                                         const std::vector<Hypothesis>& found,
                                         SearchEffort* effort = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_REFINEMENT_H_
