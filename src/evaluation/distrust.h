#ifndef HINDSIGHT_EVALUATION_DISTRUST_H_
#define HINDSIGHT_EVALUATION_DISTRUST_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Doubtful: a method distrusted a sensor for long, and the sensor agreed with
/// everything else before and after. Then either the sensor erred meanwhile or
/// what else the method had, and it cannot know which: a field that is disturbed
/// over the same time, or a vibration, look to a gate, a loss or an IMM as if the
/// positions erred.
///   long      more than ten measurements over more than 10 s, refused by a gate,
///             or left less than a tenth of their weight by a loss or by modes;
///             trusted ones between them are no more, and less than five in a row
///   agreed    of the five trusted ones next to them on each side the mean
///             normalised square a row is below its 99.9 % quantile
/// Not said where other sensors of position were trusted meanwhile, with no more
/// than 10 s between two of theirs, nor of a sensor whose error the solution has
/// as states (robust_batch): there the evidence for it has been weighed.
void FindDistrusted(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_DISTRUST_H_
