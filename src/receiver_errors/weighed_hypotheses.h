#ifndef HINDSIGHT_RECEIVER_ERRORS_WEIGHED_HYPOTHESES_H_
#define HINDSIGHT_RECEIVER_ERRORS_WEIGHED_HYPOTHESES_H_

#include <vector>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {

/// A sequence that the data do not rule out.
struct WeighedHypothesis {
  double weight = 0.0;           ///< its probability among them
  ErrorParameters parameters;    ///< as fitted to its kind
  std::vector<ErrorStep> steps;  ///< by node
  ErrorTrajectory smoothed;      ///< SmoothSequence of it
};

/// The likeliest hypotheses of the regimes, at most 24 of them (of more than 8000
/// nodes fewer, 4 at least) and at most 8 of each order of modes (ModeOrder). The
/// 8 share the weight of all hypotheses of their order, so that an order with
/// many possible change points does not drive out another.
std::vector<WeighedHypothesis> WeighHypotheses(const SensorTape& tape,
                                               const ErrorRegimes& regimes);

/// Index of the one whose horizontal positions are nearest to all, in the mean square
/// weighed by their probabilities: of those against which, beside the likeliest, odds
/// are hardly worth mentioning (10^(1/2), Jeffreys).
std::size_t MostCentral(const std::vector<WeighedHypothesis>& all);

/// sum_h w_h d_h at node k, d_h the distance of all smoothed errors of h, those
/// of the sensor among them, from those of `center`.
ErrorVector MeanFrom(const std::vector<WeighedHypothesis>& all,
                     const WeighedHypothesis& center, std::size_t k);

/// sum_h w_h d_h d_h' over the first `dim` errors at node k, d_h the distance
/// of the smoothed error of h from that of `center`.
ErrorMatrix Spread(const std::vector<WeighedHypothesis>& all,
                   const WeighedHypothesis& center, std::size_t k, int dim);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_WEIGHED_HYPOTHESES_H_
