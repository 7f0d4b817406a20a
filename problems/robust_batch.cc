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

/// A sensor that measures velocities over the ground as satellite receivers do.
bool IsOfVelocity(const SensorKind& kind) {
  return kind.moves && !kind.of_vehicle && !kind.is_position;
}

/// One way to explain the data by errors of sensors: the problem is extended by
/// them, one after the other.
class ErrorSearch {
 public:
  /// `share`: of the effort of a search that the first round may cost.
  ErrorSearch(Problem problem, const RobustBatchOptions& options, double share)
      : problem_(std::move(problem)), options_(&options), share_(share) {}

  /// Each sensor is searched with the others taken at their word.
  void Run(const std::vector<State>& initial) {
    while (rounds_.size() < kMostRounds && HasRoom()) {
      Round round;
      round.tape = std::make_unique<LinearTape>(RunLinearizedFilter(
          states_ ? *states_ : initial, &problem_, options_->callback));
      Ask();
      round.errors = FindReceiverErrors(problem_, *round.tape, question_);
      if (round.errors.empty()) break;
      const bool stands = round.errors.front().Stands();
      Take(std::move(round));
      if (!stands) break;
    }
  }

  /// Velocities are searched first, without the positions, which may err as they
  /// do; then the rest about what was found of them. False if nothing was.
  bool RunFromVelocities(const std::vector<State>& initial) {
    Problem without = problem_;
    const Timeline& timeline = problem_.timeline;
    for (std::size_t i = 0; i < without.decisions.size(); ++i) {
      const auto sensor =
          static_cast<std::size_t>(timeline.all_measurements()[i].sensor);
      if (timeline.sensors()[sensor].kind->is_position) {
        without.decisions[i] = 0;
      }
    }
    Ask();
    ErrorQuestion question = question_;
    for (std::size_t i = 0; i < timeline.sensors().size(); ++i) {
      if (!IsOfVelocity(*timeline.sensors()[i].kind)) {
        question.known.push_back(static_cast<int>(i));
      }
    }
    Round round;
    round.tape = std::make_unique<LinearTape>(
        RunLinearizedFilter(initial, &without, options_->callback));
    round.errors = FindReceiverErrors(without, *round.tape, question);
    if (round.errors.empty() || !round.errors.front().Stands()) return false;
    Take(std::move(round));
    Run(initial);
    return true;
  }

  /// Whether velocities and positions of a receiver may err together in what is
  /// told otherwise: by steps of the IMU's velocity, by errors that are doubtful
  /// by themselves, or by those of several sensors.
  bool MayBeOfAReceiver() const {
    const auto& sensors = problem_.timeline.sensors();
    const bool has_velocities = std::ranges::any_of(
        sensors, [](const Sensor& one) { return IsOfVelocity(*one.kind); });
    if (!has_velocities || question_.known.empty()) return false;
    const ReceiverErrors& first = rounds_.front().errors.front();
    return question_.known.size() > 1 || first.HasVelocitySteps() ||
           !first.Doubts().empty();
  }

  const SensorKind& KindOf(const ReceiverErrors& errors) const {
    const auto sensor = static_cast<std::size_t>(errors.sensor());
    return *problem_.timeline.sensors()[sensor].kind;
  }

  /// ln of how much likelier changes of the errors of velocities are than those of
  /// independent sensors, where errors of positions change at the same time.
  double LogOfCoincidences() const {
    constexpr double kTogether = 0.5;
    constexpr double kSameTime = 1.5;  // [s]
    std::vector<double> of_positions;
    for (const Round& round : rounds_) {
      const ReceiverErrors& one = round.errors.front();
      if (!one.Stands() || !KindOf(one).is_position) continue;
      const std::vector<double> times = one.ChangeTimes();
      of_positions.insert(of_positions.end(), times.begin(), times.end());
    }
    double log = 0.0;
    for (const Round& round : rounds_) {
      const ReceiverErrors& one = round.errors.front();
      if (!one.Stands() || !IsOfVelocity(KindOf(one))) continue;
      for (const double t : one.ChangeTimes()) {
        const bool together = std::ranges::any_of(of_positions, [t](double at) {
          return std::abs(at - t) < kSameTime;
        });
        if (together) {
          log += std::max(0.0, std::log(kTogether * one.searched_fixes()));
        }
      }
    }
    return log;
  }

  /// Whether errors of velocities change where those of positions do.
  bool HasCoincidences() const { return LogOfCoincidences() > 0.0; }

  /// ln of the evidence, as the batch is solved with what was found: without steps
  /// of the IMU's velocity, its noise as stated. Only differences mean anything.
  double LogEvidence() const {
    Problem problem = problem_;
    const LinearTape tape =
        RunLinearizedFilter(*states_, &problem, options_->callback);
    double log = LogOfCoincidences();
    for (std::size_t k = 0; k < tape.size(); ++k) {
      for (const TapeMeasurement& z : tape.measurements(k)) {
        if (z.accepted && !z.withheld) log += z.log_likelihood;
      }
    }
    for (const Round& round : rounds_) {
      const ReceiverErrors& one = round.errors.front();
      if (one.Stands()) log += one.LogOfPrior();
    }
    return log;
  }
  const Problem& problem() const { return problem_; }
  /// The trajectory to solve from; none if nothing stands.
  const std::optional<std::vector<State>>& states() const { return states_; }
  /// What stands, in words.
  std::string InWords() const {
    std::string words;
    for (const Round& round : rounds_) {
      if (!round.errors.front().Stands()) break;
      words += (words.empty() ? "" : "; ") + round.errors.front().InWords();
    }
    return words;
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
  static constexpr std::size_t kMostRounds = 3;

  /// Extends the problem by what stands of a round.
  void Take(Round round) {
    const ReceiverErrors& best = round.errors.front();
    if (best.Stands()) {
      best.Extend(&problem_);
      states_ = best.States(problem_.layout);
      question_.known.push_back(best.sensor());
    }
    rounds_.push_back(std::move(round));
  }

  /// Whether a state can hold the errors of one more sensor.
  bool HasRoom() const {
    constexpr int kOwnStates = 6;
    return problem_.layout.parameter_count() + kOwnStates <= kMaxParameters &&
           problem_.layout.dim() + kOwnStates <= kMaxErrorDim;
  }

  void Ask() {
    const std::size_t i = rounds_.size();
    const bool decided =
        options_->decisions != nullptr && i < options_->decisions->size();
    question_.decided = decided ? &(*options_->decisions)[i] : nullptr;
    const auto round = static_cast<double>(i);
    question_.share = share_ * std::exp2(-round);
    question_.go_on = [&go_on = options_->go_on, round](double fraction) {
      // A round takes half of what is left.
      return !go_on || go_on(1.0 - std::exp2(-(round + fraction)));
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

  Problem problem_;
  const RobustBatchOptions* options_;
  double share_;
  ErrorQuestion question_;
  std::vector<Round> rounds_;
  std::optional<std::vector<State>> states_;
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

/// What else explains the data, in another order of the sensors.
struct RivalSearch {
  std::vector<State> states;
  std::string words;
  double log_odds = 0.0;  ///< against it
};

struct Explained {
  ErrorSearch search;
  std::optional<RivalSearch> rival;
};

/// The likelier of the explanations. `share`: of the effort of a search.
Explained Explain(const Problem& problem, const std::vector<State>& initial,
                  const RobustBatchOptions& options, double share) {
  ErrorSearch search(problem, options, share);
  search.Run(initial);
  if (options.decisions != nullptr || !search.MayBeOfAReceiver()) {
    return {std::move(search), std::nullopt};
  }
  ErrorSearch other(problem, options, 0.5 * share);
  if (!other.RunFromVelocities(initial) || !other.HasCoincidences()) {
    return {std::move(search), std::nullopt};
  }
  double log_odds = search.LogEvidence() - other.LogEvidence();
  if (!std::isfinite(log_odds)) return {std::move(search), std::nullopt};
  if (log_odds < 0.0) {
    std::swap(search, other);
    log_odds = -log_odds;
  }
  RivalSearch rival = {*other.states(), other.InWords(), log_odds};
  return {std::move(search), std::move(rival)};
}

/// Tells of a rival to odds of a thousand, where it leads elsewhere, and widens the
/// covariances by what it is worth.
void TellRival(const RivalSearch& rival, const std::string& words,
               RobustBatchResult* result) {
  constexpr double kSureOdds = 6.907755278982137;  // ln 1000
  constexpr double kSigmas = 3.0;
  if (rival.log_odds >= kSureOdds) return;
  const double probability = 1.0 / (1.0 + std::exp(rival.log_odds));
  const int at = result->problem.layout.Find(BlockKind::kPosition)->offset;
  double farthest = 0.0;
  bool apart = false;
  for (std::size_t k = 0; k < rival.states.size(); ++k) {
    const Eigen::Vector3d d = rival.states[k].p_e - result->batch.states[k].p_e;
    ErrorMatrix P = result->batch.P.Get(k);
    apart |=
        d.squaredNorm() > kSigmas * kSigmas * P.block<3, 3>(at, at).trace();
    farthest = std::max(farthest, d.norm());
    P.block<3, 3>(at, at) += probability * d * d.transpose();
    result->batch.P.Set(k, P);
  }
  if (!apart) return;
  result->doubts.push_back(
      {.grade = Grade::kDoubtful,
       .what = fmt::format("{}; or else, {:.2g} % likely and up to {:.3g} m "
                           "away, {}",
                           words, 100.0 * probability, farthest, rival.words),
       .value = probability,
       .unit = "probability",
       .causes = {"errors of positions and velocities that come together"},
       .remedies = {"'--without', which leaves one of them out"}});
}

RobustBatchResult SolveAbout(const Problem& problem,
                             const std::vector<State>& initial,
                             const RobustBatchOptions& options, double share) {
  const Explained explained = Explain(problem, initial, options, share);
  const ErrorSearch& search = explained.search;
  RobustBatchResult result = {.problem = search.problem()};
  auto states = search.states();
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
    if (explained.rival && result.stands) {
      TellRival(*explained.rival, search.InWords(), &result);
    }
  }
  result.decisions = search.Decisions();
  if (!options.blunders.empty()) {
    result.notes.push_back(DescribeBlunders(result.problem, options.blunders));
  }
  return result;
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

/// The states of a solution over the layout without errors of sensors.
std::vector<State> WithoutErrors(const ErrorLayout& layout,
                                 std::vector<State> states) {
  for (State& x : states) {
    x.parameters.conservativeResize(layout.parameter_count());
  }
  return states;
}

}  // namespace

RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   const RobustBatchOptions& options) {
  constexpr int kMostPasses = 3;
  std::vector<State> nominal = initial;
  std::optional<RobustBatchResult> result;
  bool stopped = false;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    RobustBatchOptions of_pass = options;
    if (options.go_on) {
      of_pass.go_on = [&options, &stopped, pass](double fraction) {
        // Another pass takes half of what is left.
        const bool on = options.go_on(1.0 - std::exp2(-(pass + fraction)));
        stopped |= !on;
        return on;
      };
    }
    const double share = pass == 0 ? 1.0 : 0.5;
    RobustBatchResult one = SolveAbout(problem, nominal, of_pass, share);
    if (pass > 0 && !one.stands) break;
    result = std::move(one);
    const bool again = result->stands && !stopped &&
                       options.decisions == nullptr &&
                       IsBeyondLinear(nominal, *result);
    if (!again) break;
    nominal = WithoutErrors(problem.layout, result->batch.states);
  }
  return *std::move(result);
}

}  // namespace hindsight
