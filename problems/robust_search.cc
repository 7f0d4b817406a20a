#include "problems/robust_search.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <utility>

#include "base/error.h"
#include "measurements/sensor_kind.h"
#include "problems/blunders.h"
#include "problems/clock_choice.h"
#include "problems/open_biases.h"
#include "problems/outlier_rows.h"
#include "problems/rough_trajectory.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

/// The problem with every position used but blunders, whatever gates decided, and
/// a prior that does not trust the fix from which the start comes.
Problem WithAll(const MethodStage& stage,
                const std::vector<std::size_t>& blunders, Problem problem) {
  const Timeline& timeline = problem.timeline;
  for (std::size_t i = 0; i < problem.decisions.size(); ++i) {
    const Measurement& z = timeline.all_measurements()[i];
    const auto sensor = static_cast<std::size_t>(z.sensor);
    if (timeline.sensors()[sensor].kind->is_position) {
      problem.decisions[i] = static_cast<char>(!z.withheld);
    }
  }
  for (const std::size_t i : blunders) problem.decisions[i] = 0;
  const Start& start = stage.forward().start();
  problem.prior = WithoutTrustIn(start.position_sensor, start).prior;
  return problem;
}

using Clock = std::chrono::steady_clock;

RobustBatchOptions OptionsOf(const MethodStage& stage,
                             const GateDecisions& gates,
                             Clock::time_point end) {
  const ReconstructionOptions& options = stage.forward().options();
  return {.batch = stage.MakeBatchOptions(),
          .gates = gates,
          .callback = stage.forward().Progress("robust_batch"),
          .go_on =
              [&options, end](double fraction) {
                if (options.stop != nullptr && *options.stop) {
                  throw Interrupted();
                }
                if (options.progress) {
                  options.progress("errors of sensors", fraction);
                }
                return Clock::now() < end;
              },
          .until = end};
}

/// The plain batch, of which covariances hold what was left open.
Solution SolvePlainly(MethodStage* stage, const MethodStage::Nodes& nodes,
                      const SearchDecisions& decisions) {
  BatchResult result =
      SolveBatch(*nodes.states, stage->MakeBatchOptions(), nodes.problem);
  Solution solution =
      stage->FromSmoothed(std::move(result.states), std::move(result.P), nodes);
  solution.iterations = result.iterations;
  solution.converged = result.converged;
  solution.notes = WidenByOpenBiases(decisions, *nodes.problem, solution.states,
                                     &solution.covariances);
  stage->JudgeHeading(solution, nodes);
  return solution;
}

/// With the errors that were found.
Solution TakeRobust(RobustBatchResult result, MethodStage* stage,
                    RobustSearch* searched, std::vector<Evidence>* doubts) {
  constexpr double kErring = 0.5;  // weight
  Solution solution =
      SmoothedSolution(result.problem, std::move(result.batch.states),
                       std::move(result.batch.P));
  Timeline& timeline = result.problem.timeline;
  stage->SetFit(
      JudgeFit(stage->forward().dataset(),
               {.states = solution.states,
                .variances = VariancesOf(solution.layout, solution.covariances),
                .smoother = {}},
               &result.problem, stage->forward().Progress("grading")));
  solution.notes = WidenByOpenBiases(searched->decisions, result.problem,
                                     solution.states, &solution.covariances);
  DoubtOutliersAtGaps(timeline, solution.residuals, doubts);
  searched->erring.clear();
  std::size_t record = 0;
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    for (const Measurement& z : timeline.measurements(k)) {
      ResidualRecord& r = solution.residuals[record++];
      const std::vector<double>& trust =
          result.trust[static_cast<std::size_t>(z.sensor)];
      if (!trust.empty() && !z.withheld) r.weight *= trust[k];
      if (r.accepted && !z.withheld && r.weight < kErring) {
        searched->erring.insert({z.sensor, z.t});
      }
    }
  }
  solution.iterations = result.batch.iterations;
  solution.converged = result.batch.converged;
  if (!result.modes.names.empty()) solution.modes = std::move(result.modes);
  solution.bounded = std::move(result.bounded);
  searched->log_prior = result.log_prior;
  searched->problem.reset();
  if (HasClocksInQuestion(*stage->clocks().given)) {
    searched->problem = result.problem;
  }
  stage->SetTimeline(std::move(timeline));
  return solution;
}

/// Nodes that moved by less than a sigma hold the same errors at the same fixes.
bool IsKnownStill(const RobustSearch& searched) {
  constexpr double kMoved = 1.0;  // sigma
  return searched.done && FarthestFromNodes(searched.layout, searched.offsets,
                                            searched.x, searched.P, kMoved) < 0;
}

Evidence DoubtOfLeftOut(const Timeline& timeline,
                        const std::vector<int>& left_out, bool unasked) {
  std::vector<std::string> names;
  for (const int sensor : left_out) {
    names.push_back(timeline.sensors()[static_cast<std::size_t>(sensor)].name);
  }
  return {
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "{} left out: all others contradict it, {}", fmt::join(names, ", "),
          unasked ? "and there was no time to ask for its errors"
                  : "whatever errors it is given"),
      .causes = {"a field of the surroundings, or of currents, that is "
                 "larger than the Earth's"},
      .remedies = {"'--without', which leaves it out of all methods"}};
}

/// Whether nodes are to be placed where a rough trajectory has the clocks: those that
/// were chosen, fixes that err may have turned. Not once errors have been sought: what was
/// found is of nodes that a solution follows.
bool IsElsewhere(const RoughTrajectory& rough, const MethodStage::Nodes& nodes,
                 const RobustSearch& searched) {
  constexpr int kMostPlaced = 3;
  return !searched.done && searched.placed < kMostPlaced &&
         FarthestFromNodes(
             nodes.problem->layout, *nodes.offsets, rough.states.back(),
             rough.P.Get(rough.states.size() - 1), kElsewhere) >= 0;
}

/// Searches, unless what was decided holds still, or there is no time: then the nodes
/// have the trajectory that followed from it. Where the rough trajectory has clocks
/// elsewhere it is that trajectory, and nothing is done yet.
Solution SolveRobustly(MethodStage* stage, const MethodStage::Nodes& nodes,
                       RobustSearch* searched) {
  const bool known =
      IsKnownStill(*searched) || (searched->done && searched->IsOutOfTime());
  const std::vector<std::size_t> blunders =
      FindBlunders(nodes.problem->timeline);
  Problem problem = WithAll(*stage, blunders, *nodes.problem);
  std::vector<State> initial;
  if (known || searched->begins_at_nodes) {
    initial = *nodes.states;
  } else {
    RoughTrajectory rough =
        RoughlySolved(*stage, nodes, problem,
                      !blunders.empty() || !searched->left_out.empty());
    if (IsElsewhere(rough, nodes, *searched)) {
      ++searched->placed;
      stage->KnowMore();
      return SmoothedSolution(problem, std::move(rough.states),
                              std::move(rough.P));
    }
    initial = std::move(rough.states);
    searched->last = std::move(rough.contradicted);
  }
  RobustBatchOptions options =
      OptionsOf(*stage, nodes.problem->decisions, searched->end);
  options.blunders = blunders;
  options.last = searched->last;
  if (known) options.decisions = &searched->decisions;
  options.met = &searched->decisions;
  RobustBatchResult result =
      SolveRobustBatch(std::move(problem), initial, options);
  if (!known) {
    searched->decisions = std::move(result.decisions);
    searched->offsets = *nodes.offsets;
    searched->other_order = std::move(result.other_order);
    if (!result.left_out.empty()) {
      searched->left_out = std::move(result.left_out);
      searched->left_out_unasked = result.left_out_unasked;
      searched->last.clear();
    }
    searched->ended |= result.ended;
  }
  searched->stands = result.stands;
  searched->notes = std::move(result.notes);
  std::vector<Evidence> doubts = std::move(result.doubts);
  if (searched->other_order) doubts.push_back(*searched->other_order);
  if (!searched->left_out.empty()) {
    doubts.push_back(DoubtOfLeftOut(nodes.problem->timeline, searched->left_out,
                                    searched->left_out_unasked));
  }
  Solution solution =
      result.stands ? TakeRobust(std::move(result), stage, searched, &doubts)
                    : SolvePlainly(stage, nodes, searched->decisions);
  stage->SetDoubts(std::move(doubts));
  return solution;
}

}  // namespace

Solution SearchAtOwnNodes(MethodStage* stage, RobustSearch* searched) {
  return stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    // Nodes that move by a part of their time offset's sigma give no errors to
    // a sensor that had none.
    LeaveOut(searched->left_out, nodes.problem->timeline,
             &nodes.problem->decisions);
    const bool plain = searched->done && !searched->stands;
    const int placed = searched->placed;
    Solution one = plain ? SolvePlainly(stage, nodes, searched->decisions)
                         : SolveRobustly(stage, nodes, searched);
    if (searched->placed > placed) return one;
    one.notes.insert(one.notes.begin(), searched->notes.begin(),
                     searched->notes.end());
    one.left_out = searched->left_out;
    searched->done = true;
    searched->layout = one.layout;
    searched->x = one.states.back();
    searched->P = one.covariances.Get(one.states.size() - 1);
    return one;
  });
}

}  // namespace hindsight
