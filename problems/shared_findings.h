#ifndef HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
#define HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_

#include <vector>

#include "state/solution.h"

namespace hindsight {

/// What a method that searches for errors of sensors (MethodTrait::kSearches) has found
/// in a recording holds for all that see the whole interval, though they take the sensors
/// at their word: they become doubtful, if they are usable,
///   - by what makes its own result doubtful, whichever of the two is nearer to the
///     truth, but for a search that was ended;
///   - where the mean NEES of the position that it expects of them, an axis,
///       mean_k tr(P_k^-1 (d_k d_k' + S_k)) / 3
///     exceeds the square of kUnusableBias, d_k being how far the two are apart, S_k its
///     own covariance and P_k theirs. Not of solutions on other nodes.
void ShareFindings(std::vector<Solution>* solutions);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
