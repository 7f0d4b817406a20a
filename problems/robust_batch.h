#ifndef HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
#define HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_

#include <string>
#include <vector>

#include "problems/batch.h"
#include "problems/error_regimes.h"

namespace hindsight {

struct RobustBatchResult {
  ErrorLayout
      layout;  ///< with the receiver's Gauss-Markov error, if it has one
  BatchResult batch;
  /// The timeline as it was solved: sigmas, loss and error steps as found.
  Timeline timeline;
  GateDecisions decisions;
  ErrorRegimes regimes;
  std::vector<Eigen::VectorXd> probabilities;  ///< of the modes, by node
  std::vector<std::string> notes;              ///< what was found, in words

  /// Probability that a fix at node k is taken at its word: not as biased.
  double Trust(std::size_t k) const;
};

/// Whole-interval least squares that finds out by itself what a position
/// sensor's errors are like.
///
/// ChooseRegimes fits white, Gauss-Markov and switching errors to the data,
/// about the trajectory `initial`, and takes the one that explains them best.
/// The batch then has
///   - the sensor's sigmas as found, with a two-component mixture as its loss;
///   - the Gauss-Markov error, if there is one, as three states a node, with
///     sigma and tau as found. Over an interval into node k they do what the
///     modes there say: phi of the likeliest mode, variance
///     sum_j p_j(k) q_j over the modes j of more than one per cent, so that
///     doubt of a jump leaves the error free rather than exact.
/// It starts from the smoothed multiple-model trajectory. `receiver` is the
/// index of the sensor.
RobustBatchResult SolveRobustBatch(const ErrorLayout& layout,
                                   const Prior& prior,
                                   const std::vector<State>& initial,
                                   int receiver, Timeline timeline,
                                   const GateDecisions& decisions,
                                   const BatchOptions& options,
                                   const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
