#ifndef HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
#define HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_

#include <vector>

#include "state/solution.h"

namespace hindsight {

/// What a method that searches for errors of sensors (MethodTrait::kSearches) has found
/// in a recording holds for all that see the whole interval, though they take the sensors
/// at their word: they become doubtful, if they are usable, by what makes its own result
/// doubtful, but for a search that was ended, and by what it says of them
/// (Solution::of_others).
void ShareFindings(std::vector<Solution>* solutions);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
