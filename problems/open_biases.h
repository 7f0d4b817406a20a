#ifndef HINDSIGHT_PROBLEMS_OPEN_BIASES_H_
#define HINDSIGHT_PROBLEMS_OPEN_BIASES_H_

#include <string>
#include <vector>

#include "problems/robust_batch.h"
#include "state/covariance_series.h"
#include "timeline/problem.h"

namespace hindsight {

/// Widens the covariances P of a solution, states of `problem`, by the slow errors of
/// sensors that noise does not rule out (ExtendByOpenBias), as of a mixture: the states
/// stay as they are, and
///   P + sum_i w_i (P_i - P_0 + d_i d_i'),
/// w_i being the probability that sensor i errs so, P_i the covariance of the problem with
/// its error, d_i how far that moves the states, and P_0 the covariance without, both about
/// the same states. Where the layout has no room for the error block of one more sensor P
/// stays as it is. Returns what is held, in words (OpenBiasInWords).
std::vector<std::string> WidenByOpenBiases(const SearchDecisions& decisions,
                                           const Problem& problem,
                                           const std::vector<State>& states,
                                           CovarianceSeries* P);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_OPEN_BIASES_H_
