#ifndef HINDSIGHT_PROBLEMS_IMU_LEAPS_H_
#define HINDSIGHT_PROBLEMS_IMU_LEAPS_H_

#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// What a drop-out of the IMU may be instead: a leap of its clock, with no
/// sample lost, so that what follows is stamped late by the drop-out less the
/// usual sample interval. The longest kMostLeaps drop-outs of the interval are
/// tried, each solved to its end from the start of `chosen`, which has run, and
/// compared by LogEvidenceRatio, a leap being taken as twenty times rarer
/// beforehand. Told are those whose position, velocity or attitude is a standard
/// deviation or more from that of `chosen`, in the root mean square over the
/// nodes of both. Their evidence is above 0 where they are likelier, 30 at most;
/// the probabilities are not set yet.
std::vector<RivalSolution> ImuLeaps(ForwardStage* chosen);

inline constexpr int kMostLeaps = 3;

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_IMU_LEAPS_H_
