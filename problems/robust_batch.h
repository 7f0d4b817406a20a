#ifndef HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
#define HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_

#include <string>
#include <vector>

#include "problems/batch.h"
#include "problems/error_regimes.h"

namespace hindsight {

struct RobustBatchResult {
  ErrorLayout
      layout;         ///< with the receiver's error and its rate, if it has one
  BatchResult batch;  ///< P widened by the other histories
  /// The timeline as it was solved: sigmas, loss and error steps as found.
  Timeline timeline;
  GateDecisions decisions;
  ErrorRegimes regimes;
  /// Probabilities of the modes "good", "biased", "drifting", "slight", by
  /// node.
  std::vector<Eigen::VectorXd> probabilities;
  std::vector<std::string> notes;  ///< what was found, in words

  /// Probability that a fix at node k is taken at its word: not as biased.
  double Trust(std::size_t k) const;
};

/// Whole-interval least squares that finds out by itself what a position
/// sensor's errors are like.
///
/// ChooseRegimes fits white, Gauss-Markov and switching errors to the data,
/// about the trajectory `initial`, and takes the kind that explains them best.
/// The batch then has
///   - the sensor's sigmas as found, with a two-component mixture as its loss;
///   - the receiver's error as three states a node, and if it drifts its rate
///     as three more (imu/error_drift.h), which go from node to node as a
///     history says, with sigma and tau as found.
/// Of the histories that the data do not rule out it is the most central one
/// (problems/history_alternatives.h), from whose trajectory the batch starts;
/// the distances of the others widen the covariances. `receiver` is the index
/// of the sensor.
RobustBatchResult SolveRobustBatch(const ErrorLayout& layout,
                                   const Prior& prior,
                                   const std::vector<State>& initial,
                                   int receiver, Timeline timeline,
                                   const GateDecisions& decisions,
                                   const BatchOptions& options,
                                   const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
