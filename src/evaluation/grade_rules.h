#ifndef HINDSIGHT_EVALUATION_GRADE_RULES_H_
#define HINDSIGHT_EVALUATION_GRADE_RULES_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Not usable: no epoch, states or covariances that are not finite, or an
/// iteration that did not converge.
void FindFailure(const Judged& judged, std::vector<Evidence>* evidence);

/// Not usable: an estimated time offset that does not settle.
void FindUnsettledClock(const Judged& judged, std::vector<Evidence>* evidence);

/// A solution whose sigmas do not cover what a new linearisation about it
/// changes. A smoother is doubtful where any component at any time has errors
/// of kDoubtfulError sigmas, and not usable if one has those of a systematic
/// error of kUnusableBias in the root mean square over the interval. A filter,
/// which is judged only if its smoother has kDoubtfulError in the root mean
/// square, must be beyond chance: 3.29 sigmas in the root mean square over the
/// interval are not usable, as errors that last as long as the interval reach
/// them once in a thousand times, and 1.96 are doubtful.
void FindLinearisedFarOff(const Judged& judged,
                          std::vector<Evidence>* evidence);

/// Another explanation of the data. Doubtful from a probability of 0.27 % on,
/// with which the truth is as often there as it is outside of a 3-sigma
/// interval by chance; not usable from 32 %, as often as outside of one sigma.
void FindLikelyRival(const Judged& judged, std::vector<Evidence>* evidence);

/// Not usable: a navigation state that says nothing over half of the interval.
/// A forward filter need not know everything from its first second on.
void FindUnobservedState(const Judged& judged, std::vector<Evidence>* evidence);

/// Not usable: a sensor that was shut out (evaluation/refusals.h).
void FindShutOut(const Judged& judged, std::vector<Evidence>* evidence);

/// Not usable: accepted residuals of a sensor that are in the root mean square
/// more than five times their sigma. Then the model or its noise is wrong, and
/// with them every sigma of the solution. Doubtful of a sensor that IsOutvoted.
void FindLargeResiduals(const Judged& judged, std::vector<Evidence>* evidence);

/// Doubtful: an estimate that ends at a bound of its search, where it is no
/// maximum of anything.
void FindValuesAtBounds(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GRADE_RULES_H_
