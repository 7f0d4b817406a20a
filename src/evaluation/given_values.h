#ifndef HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
#define HINDSIGHT_EVALUATION_GIVEN_VALUES_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// How many sigmas one of `count` independent normal values lies off by chance
/// with kFalseAlarms, or less (Bonferroni).
double StrainLimit(int count);

/// By how many times what chance would move it by a value ends `off` what it
/// started from: of right sigmas that is normal with the variance of the prior
/// less that of the solution, of which a hundredth of the prior's is taken at
/// least. Zero within the sigma of the prior: what ends there contradicts nothing.
double StrainOf(double off, double prior_variance, double variance);

/// Doubtful: a start value, or a constant, that ends far from what it started
/// from, in a priori sigmas. If the configuration gave it, from StrainLimit of all
/// that it gave on: that is a wrong value, sign, unit or clock, or too small a
/// sigma; so are constants that the method has beside its states, by StrainOf. If
/// the program chose it, from StrainLimit of all that it chose on: its own sigma
/// was wrong, and what helps is to give the value. A gyro bias that was given with
/// its sigma is held against that, also where the start is its combination with
/// what rest or the alignment say.
void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GIVEN_VALUES_H_
