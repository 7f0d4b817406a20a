#ifndef HINDSIGHT_PROBLEMS_BATCH_H_
#define HINDSIGHT_PROBLEMS_BATCH_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "filters/forward_filter.h"
#include "state/covariance_series.h"

namespace hindsight {

struct BatchOptions {
  int max_iterations = 50;
  /// Ceres takes 30 to 70 kB a node for its matrices. A chain longer than
  /// `whole_nodes` is solved in windows of at most `window_nodes`, in which the neighbours and
  /// the constants are held fixed, in turn with steps of the whole chain.
  std::size_t whole_nodes = 25000;
  std::size_t window_nodes = 2500;
  /// Without losses, or near to a solution with them: full Gauss-Newton steps are tried
  /// before Ceres is asked.
  bool newton_first = true;
  /// Approaches losses that redescend by graduated non-convexity. False: the
  /// start is known to be near.
  bool graduated = true;
  /// Called after each iteration with the fraction that is done, by
  /// how many are still expected (IterationProgress); may throw to stop.
  std::function<void(double)> callback;
};

struct BatchResult {
  std::vector<State> states;
  CovarianceSeries P;  ///< marginals over the layout, in the tangent at states
  int iterations = 0;
  int ceres_iterations = 0;  ///< those among them that were Ceres's
  bool converged = false;
};

/// The whole interval as one nonlinear least-squares problem:
/// IMU factors between all neighbours, a factor for every accepted measurement,
/// a prior on the first node and the constants. Starts from `initial`, a state
/// a node. Constants of the layout (IMU biases that do not walk, scale factors,
/// lever arms...) are global unknowns; their start is that of the first state.
/// Without losses full Gauss-Newton steps solve it, by the chain's structure, if
/// each is less than half of one of the two before; with losses whose start is known to be
/// near, also if each lowers the cost. Ceres solves the others. Its last steps,
/// of a size that the rounding of the cost hides, are Gauss-Newton steps again.
/// Marginal covariances of every node come from that structure in time
/// linear in the number of nodes. Throws EstimationError where an unknown is
/// undetermined, or Ceres fails.
BatchResult SolveBatch(const std::vector<State>& initial,
                       const BatchOptions& options, Problem* problem);

/// The marginal covariances alone, of the problem linearised at `states`.
CovarianceSeries BatchMarginals(const std::vector<State>& states,
                                Problem* problem);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_BATCH_H_
