#ifndef HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
#define HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_

#include <vector>

#include "state/solution.h"

namespace hindsight {

/// What makes the result of a method that searches for errors of sensors
/// (MethodTrait::kSearches) doubtful holds for all that see the whole interval, though
/// they take the sensors at their word: they become doubtful by it, if they are usable.
/// That a search was ended does not.
void ShareFindings(std::vector<Solution>* solutions);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHARED_FINDINGS_H_
