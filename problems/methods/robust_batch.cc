#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/processor_time.h"
#include "measurements/sensor_kind.h"
#include "problems/clock_evidence.h"
#include "problems/clocks_without.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/robust_search.h"

namespace hindsight {
namespace {

/// Throws EstimationError if no sensor of position is there to be judged.
void RequirePosition(const Timeline& timeline) {
  for (const Sensor& sensor : timeline.sensors()) {
    if (sensor.kind->is_position) return;
  }
  throw EstimationError("robust_batch needs a position sensor");
}

using Clock = std::chrono::steady_clock;

/// When searches that begin now have to end.
Clock::time_point EndOf(const ReconstructionOptions& options) {
  return options.max_time < 1e9
             ? Clock::now() +
                   std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(options.max_time))
             : Clock::time_point::max();
}

/// Measurements that err may have turned the clocks about which they were found. Where
/// the others tell clocks elsewhere, errors are sought there as well, and what has the
/// larger evidence counts, as LogEvidenceRatio has it.
void SearchElsewhere(MethodStage* stage, RobustSearch* searched,
                     Solution* solution) {
  const Dataset& given = *stage->clocks().given;
  if (!searched->stands || searched->erring.empty() ||
      !HasClocksInQuestion(given) || searched->IsOutOfTime()) {
    return;
  }
  std::optional<ClocksWithout> clocks =
      ChooseClocksWithout(searched->erring, given, stage->forward().options());
  if (!clocks || FarthestFromNodes(searched->layout, clocks->nodes.offsets,
                                   searched->x, searched->P, kElsewhere) < 0) {
    return;
  }
  MethodStage elsewhere(*std::move(clocks));
  RobustSearch again(searched->end);
  again.begins_at_nodes = true;
  again.decisions = searched->decisions;
  again.last = searched->last;
  again.left_out = searched->left_out;
  again.left_out_unasked = searched->left_out_unasked;
  try {
    Solution other = SearchAtOwnNodes(&elsewhere, &again);
    searched->ended |= again.ended;
    if (!again.stands) return;
    const double log_odds =
        LogEvidenceRatio(given, {*again.problem, other.states},
                         {*searched->problem, solution->states},
                         ExcessBy::kMedian) +
        again.log_prior - searched->log_prior;
    if (log_odds < kSureLogOdds) return;
    *solution = std::move(other);
  } catch (const EstimationError&) {
    // There is no trajectory beside those clocks.
    return;
  }
  *searched = std::move(again);
  *stage = std::move(elsewhere);
}

void AddDoubtOfEnded(MethodStage* stage) {
  std::vector<Evidence> doubts = stage->doubts();
  doubts.insert(
      doubts.begin(),
      {.grade = Grade::kDoubtful,
       .what = "the search for errors of sensors was ended before it was "
               "done (--max-time)",
       .causes = {"less time than the recording needs"},
       .remedies = {"a larger --max-time"},
       .is_always_told = true});
  stage->SetDoubts(std::move(doubts));
}

Solution RunRobustBatch(MethodStage* stage) {
  const double t0 = ProcessorSeconds();
  RequirePosition(stage->forward().timeline());
  RobustSearch searched(EndOf(stage->forward().options()));
  Solution solution = SearchAtOwnNodes(stage, &searched);
  SearchElsewhere(stage, &searched, &solution);
  if (searched.ended) AddDoubtOfEnded(stage);
  solution.seconds = ProcessorSeconds() - t0;
  if (!searched.stands) stage->JudgeOptimum(solution);
  return solution;
}

}  // namespace

extern const Method kRobustBatchMethod;
const Method kRobustBatchMethod = {
    .name = "robust_batch",
    .help =
        "batch that finds out from the data which sensor errs and how:\n"
        "outliers, correlated errors, jumps, drifts; else the batch",
    .traits = TraitsOf({MethodTrait::kSearches}),
    .run = RunRobustBatch,
    .work = 200.0};

}  // namespace hindsight
