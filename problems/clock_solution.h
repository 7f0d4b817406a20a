#ifndef HINDSIGHT_PROBLEMS_CLOCK_SOLUTION_H_
#define HINDSIGHT_PROBLEMS_CLOCK_SOLUTION_H_

#include <memory>
#include <vector>

#include "problems/forward_stage.h"

namespace hindsight {

/// A data set with its clocks at given offsets, solved.
struct SolvedClocks {
  std::vector<double> offsets;  ///< from which it was solved [s]
  std::unique_ptr<ForwardStage> stage;
  std::vector<State> states;  ///< a node; smoothed, after Converge the batch's
  bool converged = false;     ///< Converge was called
};

/// Filters and smooths with nodes placed at the time offsets that `dataset` has
/// now, which are `offsets`, and wherever they move; from the start that
/// FindStart finds. `dataset` must outlive the result. Throws EstimationError
/// if the clocks do not settle.
SolvedClocks SolveWithClocks(const std::vector<double>& offsets,
                             const ReconstructionOptions& options,
                             const Dataset& dataset);

/// The same at a fraction of the cost, from the attitude that AlignCoarsely
/// finds; where the configuration says something of the start, none is found or
/// it leads nowhere, as SolveWithClocks. `dataset` is given back as it was.
SolvedClocks SolveCoarsely(const std::vector<double>& offsets,
                           const ReconstructionOptions& options,
                           Dataset* dataset);

/// Solves the batch on the nodes of `solved`; without convergence its states
/// stay as they are.
void Converge(SolvedClocks* solved);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_SOLUTION_H_
