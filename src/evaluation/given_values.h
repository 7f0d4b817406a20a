#ifndef HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
#define HINDSIGHT_EVALUATION_GIVEN_VALUES_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Sigmas a priori beyond which a value contradicts what it started from.
inline constexpr double kStrained = 5.0;

/// Doubtful: a start value, or a constant, that ends more than kStrained a priori
/// sigmas from what it started from, which chance does once in two million
/// times. If the configuration gave it, that is a wrong value, sign, unit or
/// clock, or too small a sigma; if the program chose it, its own sigma was
/// wrong, and what helps is to give the value. A gyro bias that was given with
/// its sigma is held against that, also where the start is its combination with
/// what rest or the alignment say.
void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
