#include "problems/robust_batch.h"

#include <algorithm>
#include <utility>

#include "receiver_errors/receiver_errors.h"

namespace hindsight {

RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   int receiver, const BatchOptions& options,
                                   const EpochCallback& callback) {
  const LinearTape tape = RunLinearizedFilter(initial, &problem, callback);
  const ReceiverErrors errors =
      FindReceiverErrors(problem, tape, receiver, [&callback, &tape] {
        if (callback) callback(tape.size());
      });
  errors.Extend(&problem);
  BatchOptions batch = options;
  batch.graduated = false;
  // About the edge of a mixture the last steps converge linearly.
  batch.max_iterations = std::max(batch.max_iterations, 200);
  BatchResult solved =
      SolveBatch(errors.States(problem.layout), batch, &problem);
  std::vector<std::string> notes = errors.Notes(solved.P);
  errors.Widen(&solved.P);
  return {std::move(problem), std::move(solved), errors.Modes(),
          errors.Trust(),     errors.Bounded(),  std::move(notes)};
}

}  // namespace hindsight
