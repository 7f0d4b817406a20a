#ifndef HINDSIGHT_FILTERS_CONSTANT_SCORES_H_
#define HINDSIGHT_FILTERS_CONSTANT_SCORES_H_

#include <span>
#include <vector>

#include "filters/linear_tape.h"

namespace hindsight {

/// By what factor the errors of constants among the states exceed their sigmas,
/// as far as the innovations that they are read from tell. The noise of a
/// measurement of epoch k takes part in the estimate of a constant c with the
/// weight cov(c, x_k | all) H' R^-1, and what the update finds of that noise is
/// R S^-1 nu: together w nu with
///   w = cov(c, x_k | all) H' S^-1,
/// of a right model independent N(0, w S w'). Over blocks of a duration T,
///   V(T) = sum (sum of w nu)^2 / sum (sum of w S w')
/// is a weighted sum of chi-square variables for each T
/// (WeightedChiSquareQuantile): more of it is noise that is larger than stated,
/// or correlated. The factor is sqrt V, the largest of all T at which chance
/// does not reach it; 1 if there is none (the sandwich of Huber 1967 and White
/// 1980; blocks as of Newey and West 1987). T runs from a quarter of the tape
/// down by halves to the shortest interval between measurements: errors that
/// last longer than a quarter are not told from the constant. `components` are
/// of the layout, constant, in any order. `false_alarms`: probability that any
/// factor of a right model is not 1 (Bonferroni over all T and components).
/// Requires a tape about a fixed nominal; throws EstimationError where P- is not
/// positive definite.
std::vector<double> ExcessOfConstants(const LinearTape& tape,
                                      std::span<const int> components,
                                      double false_alarms);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_CONSTANT_SCORES_H_
