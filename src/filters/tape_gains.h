#ifndef HINDSIGHT_FILTERS_TAPE_GAINS_H_
#define HINDSIGHT_FILTERS_TAPE_GAINS_H_

#include <cstddef>
#include <vector>

#include "filters/linear_tape.h"

namespace hindsight {

/// Throws std::logic_error for a tape whose nominal an update moved.
void RequireFixedNominal(const LinearTape& tape);

/// J' of an interval, P+(k) Phi(k+1)' P-(k+1)^-1 times `ahead`: what the past of
/// epoch k learns from what is known of epoch k + 1. Throws EstimationError
/// where P- is not positive definite.
Eigen::MatrixXd Smoothed(const LinearTape& tape, std::size_t k,
                         const Eigen::MatrixXd& ahead);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_TAPE_GAINS_H_
