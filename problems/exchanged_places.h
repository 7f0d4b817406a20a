#ifndef HINDSIGHT_PROBLEMS_EXCHANGED_PLACES_H_
#define HINDSIGHT_PROBLEMS_EXCHANGED_PLACES_H_

#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// Longest interval in which exchanged places are sought [s]: who drives for
/// longer turns.
inline constexpr double kLongestOfExchanged = 300.0;

/// What a recording may be if latitude and longitude of a sensor of positions
/// stand for each other: the mirror image of a path, which a nearly straight one
/// hardly differs from; not sought where the heading turns by 90 deg, which gyros
/// contradict. Solved from the mirrored start of `chosen`, which has
/// run, and compared by LogEvidenceRatio, in metres of the places that were
/// measured. Told are those of RareRivals; the probabilities are not set yet.
std::vector<RivalSolution> ExchangedPlaces(ForwardStage* chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXCHANGED_PLACES_H_
