#ifndef HINDSIGHT_EVALUATION_INNOVATION_RULE_H_
#define HINDSIGHT_EVALUATION_INNOVATION_RULE_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// A sensor whose innovations are not those of the stated model, a piece of
/// evidence a sensor. Doubtful from an excess of kDoubtfulError sigmas on, not
/// usable from that of a systematic error of kUnusableBias beside what is
/// stated, but of a sensor that IsOutvoted. Doubtful where it was not tested.
void FindOddInnovations(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_INNOVATION_RULE_H_
