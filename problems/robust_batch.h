#ifndef HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
#define HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_

#include <string>
#include <vector>

#include "problems/batch.h"
#include "state/solution.h"

namespace hindsight {

struct RobustBatchResult {
  /// As it was solved: with the receiver's error and its rate, if it has one,
  /// sigmas, loss and error steps as found.
  Problem problem;
  BatchResult batch;  ///< P widened by the other histories
  ModePart modes;     ///< of the receiver
  /// By node, the probability that a fix is taken at its word: not as biased.
  std::vector<double> trust;
  std::vector<BoundedValue> bounded;
  std::vector<std::string> notes;  ///< what was found, in words
};

/// Whole-interval least squares that finds out by itself what a position
/// sensor's errors are like.
///
/// FindReceiverErrors looks for them about the trajectory `initial`. The batch
/// then has
///   - the sensor's sigmas as found, with a two-component mixture as its loss;
///   - the receiver's error as three states a node, and if it drifts its rate
///     as three more (state/block_step.h), which go from node to node as a
///     history says, with sigma and tau as found.
/// It starts from that history's trajectory; the distances of the others widen
/// the covariances. `receiver` is the index of the sensor.
RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   int receiver, const BatchOptions& options,
                                   const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
