#ifndef HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
#define HINDSIGHT_EVALUATION_GIVEN_VALUES_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Sigmas a priori beyond which a value contradicts what it started from, where
/// that comes from the same data and no law is known of it.
inline constexpr double kStrained = 5.0;

/// The same of `count` values that were given beside the data: of right sigmas
/// any of them lies beyond it with kFalseAlarms or less (Bonferroni), as the
/// difference is normal with the variance of the prior less that of the solution.
double StrainLimit(int count);

/// Doubtful: a start value, or a constant, that ends far from what it started
/// from, in a priori sigmas. If the configuration gave it, from StrainLimit of
/// all that it gave on: that is a wrong value, sign, unit or clock, or too small
/// a sigma. If the program chose it, from kStrained on, which chance does once
/// in two million times: its own sigma was wrong, and what helps is to give the
/// value. A gyro bias that was given with its sigma is held against that, also
/// where the start is its combination with what rest or the alignment say.
void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
