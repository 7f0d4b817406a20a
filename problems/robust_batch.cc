#include "problems/robust_batch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "problems/attitude_contradiction.h"
#include "problems/explained_errors.h"
#include "problems/marginal_likelihood.h"

namespace hindsight {
namespace {

/// Sensors whose errors do not stand keep what their gates decided.
void RestoreGates(const ErrorSearch& search, const GateDecisions& gates,
                  Problem* problem) {
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const int sensor = problem->timeline.all_measurements()[i].sensor;
    if (!search.HasErrors(sensor) && !search.IsLeftOut(sensor)) {
      problem->decisions[i] = gates[i];
    }
  }
}

Evidence DoubtOfUnconverged() {
  return {.grade = Grade::kDoubtful,
          .what =
              "errors of sensors were found, but the batch with them does "
              "not converge: the result is that of 'batch'",
          .causes = {"errors of another kind, or of several sensors at once"},
          .remedies = {"'--without', which leaves a sensor out"}};
}

std::string DescribeBlunders(const Problem& problem,
                             const std::vector<std::size_t>& blunders) {
  const Measurement& first =
      problem.timeline.all_measurements()[blunders.front()];
  return fmt::format(
      "{} positions that no vehicle reaches are left out, the first of {} at "
      "{:.1f} s",
      blunders.size(),
      problem.timeline.sensors()[static_cast<std::size_t>(first.sensor)].name,
      first.t);
}

/// Tells of a rival to odds of a thousand, where it leads elsewhere, and widens the
/// covariances by what it is worth.
void TellOtherOrder(const RivalSearch& rival, const std::string& words,
                    RobustBatchResult* result) {
  constexpr double kSigmas = 3.0;
  if (rival.log_odds >= kSureLogOdds) return;
  const double probability = 1.0 / (1.0 + std::exp(rival.log_odds));
  const Block* position = result->problem.layout.Find(BlockKind::kPosition);
  if (position == nullptr || position->dim != 3) return;
  const int at = position->offset;
  double farthest = 0.0;
  bool apart = false;
  for (std::size_t k = 0; k < rival.states.size(); ++k) {
    const State& x = result->batch.states[k];
    const Eigen::Vector3d d =
        x.C_en().transpose() * (rival.states[k].p_e - x.p_e);
    ErrorMatrix P = result->batch.P.Get(k);
    apart |=
        d.squaredNorm() > kSigmas * kSigmas * P.block<3, 3>(at, at).trace();
    farthest = std::max(farthest, d.norm());
    P.block<3, 3>(at, at) += probability * d * d.transpose();
    result->batch.P.Set(k, P);
  }
  if (!apart) return;
  result->other_order = Evidence(
      {.grade = Grade::kDoubtful,
       .what = DescribeEither(words, rival.words, probability, farthest),
       .value = probability,
       .unit = "probability",
       .causes = {"errors of positions and velocities that come together"},
       .remedies = {"'--without', which leaves one of them out"}});
}

/// The batch; one that has not converged where the data cannot be solved.
BatchResult SolveIfPossible(const std::vector<State>& initial,
                            const BatchOptions& options, Problem* problem) {
  try {
    return SolveBatch(initial, options, problem);
  } catch (const EstimationError&) {
    return BatchResult();
  }
}

/// Covariances by what is expected of slow errors, where these stand.
void ExpectErrors(const ErrorSearch& search, const BatchOptions& options,
                  RobustBatchResult* result) {
  std::optional<Problem> expected = search.Expected(result->problem);
  if (!expected) return;
  BatchResult batch =
      SolveIfPossible(result->batch.states, options, &*expected);
  if (batch.converged) result->batch.P = std::move(batch.P);
}

/// With the errors of an explanation, beside a rival. Where a sensor is left out, also
/// if there are none.
RobustBatchResult SolveWith(ErrorSearch* search,
                            const std::optional<RivalSearch>& rival,
                            const std::vector<State>& initial,
                            const RobustBatchOptions& options) {
  RobustBatchResult result = {.problem = search->problem()};
  auto states = search->states();
  const bool is_as_asked = options.blunders.empty() && !search->LeavesOut();
  if (!states && !is_as_asked) states = initial;
  bool unsolved = false;
  if (states) {
    RestoreGates(*search, options.gates, &result.problem);
    for (const std::size_t i : options.blunders) {
      result.problem.decisions[i] = 0;
    }
    BatchOptions batch = options.batch;
    batch.graduated = false;
    // About the edge of a mixture the last steps converge linearly.
    batch.max_iterations = std::max(batch.max_iterations, 200);
    result.batch = SolveIfPossible(*states, batch, &result.problem);
    result.stands = result.batch.converged;
    unsolved = !result.stands;
    if (result.stands) {
      search->TakeSizes(result.batch.states);
      ExpectErrors(*search, batch, &result);
    }
  }
  if (unsolved) {
    result.doubts.push_back(DoubtOfUnconverged());
  } else {
    search->Tell(&result);
    if (rival && result.stands) {
      TellOtherOrder(*rival, search->InWords(), &result);
    }
  }
  result.decisions = search->Decisions();
  result.log_prior = search->LogOfPrior();
  if (!options.blunders.empty()) {
    result.notes.push_back(DescribeBlunders(result.problem, options.blunders));
  }
  return result;
}

/// Whether a solution in which sensors of headings erred, or else the batch without
/// errors of theirs, still contradicts the one without them, or there is none.
bool StillContradicts(const RobustBatchResult& with,
                      const RobustBatchResult& without, Problem plain,
                      const std::vector<State>& initial,
                      const RobustBatchOptions& options) {
  if (with.stands) {
    return AttitudesContradict(with.problem.layout, with.batch.states,
                               without.batch.states, without.batch.P);
  }
  const BatchResult batch = SolveIfPossible(initial, options.batch, &plain);
  return !batch.converged ||
         AttitudesContradict(plain.layout, batch.states, without.batch.states,
                             without.batch.P);
}

/// With the errors that explain the data of the `plain` problem about `initial`;
/// without the sensors that all others contradict whatever errors they are given.
RobustBatchResult SolveExplained(ExplainedErrors explained,
                                 const Problem& plain,
                                 const std::vector<State>& initial,
                                 const RobustBatchOptions& options) {
  const auto solve = [&](ErrorSearch* search) {
    return SolveWith(search, explained.rival, initial, options);
  };
  const bool ended = explained.search.ended();
  if (!explained.without_last || (ended && !explained.without_last->states())) {
    return solve(&explained.search);
  }
  RobustBatchResult without = solve(&*explained.without_last);
  without.left_out = options.last;
  without.left_out_unasked = ended;
  if (without.stands && ended) return without;
  RobustBatchResult with = solve(&explained.search);
  return without.stands &&
                 StillContradicts(with, without, plain, initial, options)
             ? without
             : with;
}

/// With errors sought once more, about the trajectory of another solution; none if
/// the data cannot be solved about it, or `ended` says that there was no time.
std::optional<RobustBatchResult> SolveAgain(const Problem& problem,
                                            const std::vector<State>& initial,
                                            const RobustBatchOptions& options,
                                            const bool& ended) {
  constexpr double kShare = 0.5;
  try {
    ExplainedErrors explained =
        ExplainErrors(problem, initial, options, kShare);
    if (ended) return std::nullopt;
    return SolveExplained(std::move(explained), problem, initial, options);
  } catch (const EstimationError&) {
    return std::nullopt;
  }
}

/// Whether the attitude of a solution is so far from that about which errors were
/// sought that what is quadratic in their distance, theta^2 / 2, is more than three
/// sigmas: then the search has judged another trajectory than the batch.
bool IsBeyondLinear(const std::vector<State>& nominal,
                    const RobustBatchResult& result) {
  constexpr double kSigmas = 3.0;
  const Block* attitude = result.problem.layout.Find(BlockKind::kAttitude);
  if (attitude == nullptr || attitude->dim != 3) return false;
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const double theta =
        nominal[k].q_eb.angularDistance(result.batch.states[k].q_eb);
    const ErrorMatrix P = result.batch.P.Get(k);
    const double variance =
        P.diagonal().segment<3>(attitude->offset).maxCoeff();
    if (0.5 * theta * theta > kSigmas * std::sqrt(variance)) return true;
  }
  return false;
}

/// ln of the evidence of a result about its own solution, by all measurements that the
/// `plain` problem uses.
double LogEvidenceOf(const RobustBatchResult& result, const Problem& plain) {
  return result.log_prior +
         MarginalLikelihoodOf(result.problem, result.batch.states,
                              plain.decisions, LikelihoodParts::kAlone)
             .log;
}

/// The states of a solution over the layout without errors of sensors.
std::vector<State> WithoutErrors(const ErrorLayout& layout,
                                 std::vector<State> states) {
  for (State& x : states) {
    x.parameters.conservativeResize(layout.parameter_count());
  }
  return states;
}

}  // namespace

void LeaveOut(const std::vector<int>& sensors, const Timeline& timeline,
              GateDecisions* decisions) {
  for (std::size_t i = 0; i < decisions->size(); ++i) {
    const int sensor = timeline.all_measurements()[i].sensor;
    if (std::ranges::count(sensors, sensor) > 0) (*decisions)[i] = 0;
  }
}

RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   const RobustBatchOptions& options) {
  constexpr int kMostPasses = 3;
  bool ended = false;
  int pass = 0;
  RobustBatchOptions of_pass = options;
  if (options.go_on) {
    of_pass.go_on = [&](double fraction) {
      // Another pass takes half of what is left.
      ended |= !options.go_on(1.0 - std::exp2(-(pass + fraction)));
      return !ended;
    };
  }
  RobustBatchResult result = SolveExplained(
      ExplainErrors(problem, initial, of_pass, 1.0), problem, initial, of_pass);
  if (!result.left_out.empty()) {
    LeaveOut(result.left_out, problem.timeline, &problem.decisions);
    LeaveOut(result.left_out, problem.timeline, &of_pass.gates);
    of_pass.last.clear();
  }
  std::vector<State> nominal = initial;
  while (++pass < kMostPasses && result.stands &&
         options.decisions == nullptr && IsBeyondLinear(nominal, result)) {
    if (of_pass.go_on && !of_pass.go_on(0.0)) break;
    nominal = WithoutErrors(problem.layout, result.batch.states);
    of_pass.met = &result.decisions;
    std::optional<RobustBatchResult> again =
        SolveAgain(problem, nominal, of_pass, ended);
    if (!again || !again->stands ||
        LogEvidenceOf(*again, problem) < LogEvidenceOf(result, problem)) {
      break;
    }
    again->left_out = result.left_out;
    again->left_out_unasked = result.left_out_unasked;
    result = *std::move(again);
  }
  result.ended = ended;
  return result;
}

}  // namespace hindsight
