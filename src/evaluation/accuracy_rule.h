#ifndef HINDSIGHT_EVALUATION_ACCURACY_RULE_H_
#define HINDSIGHT_EVALUATION_ACCURACY_RULE_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// How well the states are known: standard deviations in the root mean square
/// over the interval, and at worst. What no recording shows is said with it: an
/// error that lasts of the only sensor of places, where it is stated to have
/// none, and what is hidden by sigmas of what tells the place that are
/// kUnusableError times what its innovations say. Never lowers the grade.
void DescribeAccuracy(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_ACCURACY_RULE_H_
