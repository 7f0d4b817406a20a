#ifndef HINDSIGHT_PROBLEMS_CERES_WINDOWS_H_
#define HINDSIGHT_PROBLEMS_CERES_WINDOWS_H_

#include "problems/batch.h"
#include "problems/chain_problem.h"
#include "problems/iteration_progress.h"

namespace hindsight {

/// Iterations that a solve usually takes in Ceres, by which the remaining time
/// is told.
inline constexpr int kUsualIterations = 3;

/// What a solve of all windows took.
struct Sweep {
  int iterations = 0;        ///< the most of any window
  int ceres_iterations = 0;  ///< those among them that were Ceres's
  bool converged = true;
};

/// Root mean square of a step, a node [m, m/s, rad...], at which Ceres ends.
double RoughStep(const ChainProblem& chain);

/// Whether the chain is so long that Ceres solves it in windows.
bool IsWindowed(const BatchOptions& options, const ChainProblem& chain);

/// Solves every window by Ceres once, from the first to the last, with its
/// neighbours and the constants held fixed; a chain that is not long is one
/// window, and nothing of it fixed. `later` iterations are expected after them.
/// Throws EstimationError if Ceres fails, and what the progress throws.
Sweep SolveWindows(const BatchOptions& options, int max_iterations,
                   double later, IterationProgress* progress,
                   ChainProblem* chain);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CERES_WINDOWS_H_
