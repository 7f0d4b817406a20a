#ifndef HINDSIGHT_PROBLEMS_RIVAL_DATA_H_
#define HINDSIGHT_PROBLEMS_RIVAL_DATA_H_

#include <optional>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// Solves `rival`, a stage of the recording as it may be instead, to its end and
/// compares it with `chosen`, which has run, by LogEvidenceRatio and `log_odds`,
/// what is known beforehand. Returns `words` with evidence, 30 at most, and end;
/// nothing where the position, velocity and attitude of both are less than a
/// standard deviation apart, in the root mean square over the nodes of both, or
/// where the rival is hopeless. Throws EstimationError where it cannot be solved.
std::optional<RivalSolution> SolveRival(double log_odds, RivalSolution words,
                                        ForwardStage* rival,
                                        ForwardStage* chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_RIVAL_DATA_H_
