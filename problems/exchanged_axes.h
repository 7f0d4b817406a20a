#ifndef HINDSIGHT_PROBLEMS_EXCHANGED_AXES_H_
#define HINDSIGHT_PROBLEMS_EXCHANGED_AXES_H_

#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// What a recording may be if gyros or accelerometers have other signs or another
/// order than they are said to have: each axis of either the other way round, two
/// axes for each other, with the same signs or both with the other, and all gyros
/// the other way round. Sought where such a fault
/// is within what the sigmas allow: in intervals of up to kLongestOfExchanged, of
/// sensors that StateTooMuch. Each is aligned and solved anew and compared with
/// `chosen`, which has run, by LogLikelihoodRatio. Told are those of RareRivals; the
/// probabilities are not set yet.
std::vector<RivalSolution> ExchangedAxes(ForwardStage* chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXCHANGED_AXES_H_
