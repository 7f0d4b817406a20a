#include "problems/clock_solution.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "problems/batch.h"
#include "problems/coarse_start.h"

namespace hindsight {
namespace {

SolvedClocks Settled(const std::vector<double>& offsets,
                     std::unique_ptr<ForwardStage> stage) {
  stage->Run();
  SolvedClocks solved;
  solved.offsets = offsets;
  solved.states = stage->smoothed().states;
  solved.stage = std::move(stage);
  return solved;
}

}  // namespace

SolvedClocks SolveWithClocks(const std::vector<double>& offsets,
                             const ReconstructionOptions& options,
                             const Dataset& dataset) {
  return Settled(offsets, std::make_unique<ForwardStage>(dataset, options));
}

SolvedClocks SolveCoarsely(const std::vector<double>& offsets,
                           const ReconstructionOptions& options,
                           Dataset* dataset) {
  if (std::optional<Start> start = CoarseStart(options, dataset)) {
    try {
      return Settled(offsets, std::make_unique<ForwardStage>(
                                  *dataset, options, std::move(*start)));
    } catch (const EstimationError&) {
      // SolveWithClocks tries the attitude that FindStart finds.
    }
  }
  return SolveWithClocks(offsets, options, *dataset);
}

void Converge(SolvedClocks* solved) {
  solved->converged = true;
  ForwardStage& stage = *solved->stage;
  BatchOptions batch;
  batch.max_iterations = stage.options().max_iterations;
  const EpochCallback progress = stage.Progress("clocks");
  batch.callback = [&progress](int) { progress(0); };
  BatchResult result = SolveBatch(solved->states, batch, &stage.problem());
  if (result.converged) solved->states = std::move(result.states);
}

}  // namespace hindsight
