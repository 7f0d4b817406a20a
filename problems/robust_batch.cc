#include "problems/robust_batch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace hindsight {
namespace {

/// Errors found about one tape, which they need.
struct Round {
  std::unique_ptr<LinearTape> tape;
  std::vector<ReceiverErrors> errors;  ///< one a sensor; the best first
};

class ErrorSearch {
 public:
  ErrorSearch(Problem* problem, const RobustBatchOptions& options)
      : problem_(*problem), options_(options) {}

  /// Extends the problem round by round. The trajectory to solve from; none if
  /// nothing stands.
  std::optional<std::vector<State>> Run(const std::vector<State>& initial) {
    std::optional<std::vector<State>> states;
    ErrorQuestion question;
    for (int i = 0; i < kMostRounds && HasRoom(); ++i) {
      Round round;
      round.tape = std::make_unique<LinearTape>(RunLinearizedFilter(
          states ? *states : initial, &problem_, options_.callback));
      Ask(i, &question);
      round.errors = FindReceiverErrors(problem_, *round.tape, question);
      if (round.errors.empty()) break;
      const ReceiverErrors& best = round.errors.front();
      const bool is_last = !best.Stands() || round.errors.size() == 1;
      if (best.Stands()) {
        best.Extend(&problem_);
        states = best.States(problem_.layout);
        question.known.push_back(best.sensor());
      }
      rounds_.push_back(std::move(round));
      if (is_last) break;
    }
    return states;
  }

  bool HasErrors(int sensor) const {
    return std::any_of(rounds_.begin(), rounds_.end(), [&](const Round& one) {
      return one.errors.front().Stands() &&
             one.errors.front().sensor() == sensor;
    });
  }

  SearchDecisions Decisions() const {
    SearchDecisions all;
    for (const Round& round : rounds_) {
      all.emplace_back();
      for (const ReceiverErrors& one : round.errors) {
        all.back().push_back(one.Decisions());
      }
    }
    return all;
  }

  /// Adds to P, as solved, what else there may be; fills in the rest of a
  /// result.
  void Tell(RobustBatchResult* result) const {
    result->trust.resize(problem_.timeline.sensors().size());
    for (std::size_t i = 0; i < rounds_.size(); ++i) {
      const ReceiverErrors& best = rounds_[i].errors.front();
      // The last round may have found nothing: then it tells what was refused.
      if (!best.Stands() && i > 0) break;
      TellNotes(rounds_[i], result);
      if (!best.Stands()) break;
      std::optional<Evidence> doubt = best.Average(
          problem_.layout, &result->batch.states, &result->batch.P);
      if (doubt) result->doubts.push_back(std::move(*doubt));
      if (i == 0) result->modes = best.Modes();
      for (BoundedValue& one : best.Bounded()) {
        result->bounded.push_back(std::move(one));
      }
      result->trust[static_cast<std::size_t>(best.sensor())] = best.Trust();
      TellRival(rounds_[i], result);
    }
  }

 private:
  static constexpr int kMostRounds = 3;

  /// Whether a state can hold the errors of one more sensor.
  bool HasRoom() const {
    constexpr int kOwnStates = 6;
    return problem_.layout.parameter_count() + kOwnStates <= kMaxParameters &&
           problem_.layout.dim() + kOwnStates <= kMaxErrorDim;
  }

  void Ask(int round, ErrorQuestion* question) const {
    const auto i = static_cast<std::size_t>(round);
    const bool decided =
        options_.decisions != nullptr && i < options_.decisions->size();
    question->decided = decided ? &(*options_.decisions)[i] : nullptr;
    question->go_on = [this, round](double fraction) {
      // A round takes half of what is left.
      return !options_.go_on ||
             options_.go_on(1.0 - std::exp2(-(round + fraction)));
    };
  }

  static void TellNotes(const Round& round, RobustBatchResult* result) {
    for (const ReceiverErrors& one : round.errors) {
      const bool best = &one == &round.errors.front();
      if (best || !round.errors.front().Stands()) {
        for (std::string& note : one.Notes(result->batch.P)) {
          result->notes.push_back(std::move(note));
        }
      }
      for (Evidence& doubt : one.Doubts()) {
        if (best || doubt.value == std::nullopt) {
          result->doubts.push_back(std::move(doubt));
        }
      }
    }
  }

  /// Errors of another sensor that explain the same.
  void TellRival(const Round& round, RobustBatchResult* result) const {
    constexpr double kSureOdds = 6.907755278982137;  // ln 1000
    const ReceiverErrors& best = round.errors.front();
    for (std::size_t i = 1; i < round.errors.size(); ++i) {
      const ReceiverErrors& other = round.errors[i];
      const double behind = best.log_gain() - other.log_gain();
      if (!other.Stands() || behind >= kSureOdds) continue;
      const double probability = 1.0 / (1.0 + std::exp(behind));
      const double distance = std::sqrt(best.MeanSquareDistanceTo(other));
      if (!best.IsApart(other, result->batch.P)) continue;
      result->doubts.push_back(
          {.grade = Grade::kDoubtful,
           .what = fmt::format(
               "which sensor errs cannot be told: {}; or, {:.2g} % likely, {}",
               best.InWords(), 100.0 * probability, other.InWords()),
           .value = distance,
           .unit = "m",
           .causes = {"sensors that contradict each other where the IMU cannot "
                      "tell which is right"},
           .remedies = {"'--without', which leaves one of them out"}});
      result->notes.push_back(fmt::format(
          "or, {:.2g} % likely and {:.3g} m away in the root mean square: {}",
          100.0 * probability, distance, other.InWords()));
      best.WidenTowards(other, probability, &result->batch.P);
    }
  }

  Problem& problem_;
  const RobustBatchOptions& options_;
  std::vector<Round> rounds_;
};

/// Sensors whose errors do not stand keep what their gates decided.
void RestoreGates(const ErrorSearch& search, const GateDecisions& gates,
                  Problem* problem) {
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (!search.HasErrors(problem->timeline.all_measurements()[i].sensor)) {
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

}  // namespace

RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   const RobustBatchOptions& options) {
  RobustBatchResult result = {.problem = std::move(problem)};
  ErrorSearch search(&result.problem, options);
  auto states = search.Run(initial);
  if (!states && !options.blunders.empty()) states = initial;
  if (states) {
    RestoreGates(search, options.gates, &result.problem);
    for (const std::size_t i : options.blunders) {
      result.problem.decisions[i] = 0;
    }
    BatchOptions batch = options.batch;
    batch.graduated = false;
    // About the edge of a mixture the last steps converge linearly.
    batch.max_iterations = std::max(batch.max_iterations, 200);
    result.batch = SolveBatch(*states, batch, &result.problem);
    result.stands = result.batch.converged;
  }
  if (states && !result.stands) {
    result.doubts.push_back(DoubtOfUnconverged());
  } else {
    search.Tell(&result);
  }
  result.decisions = search.Decisions();
  if (!options.blunders.empty()) {
    result.notes.push_back(DescribeBlunders(result.problem, options.blunders));
  }
  return result;
}

}  // namespace hindsight
