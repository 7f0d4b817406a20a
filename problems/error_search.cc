#include "problems/error_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "evaluation/innovation_test.h"
#include "measurements/sensor_kind.h"
#include "problems/judged_innovations.h"

namespace hindsight {
namespace {

constexpr std::size_t kMostRounds = 3;

/// The problem with no measurement used of sensors for which `is_left_out`.
Problem Without(Problem problem,
                const std::function<bool(int sensor)>& is_left_out) {
  for (std::size_t i = 0; i < problem.decisions.size(); ++i) {
    if (is_left_out(problem.timeline.all_measurements()[i].sensor)) {
      problem.decisions[i] = 0;
    }
  }
  return problem;
}

}  // namespace

bool IsOfVelocity(const SensorKind& kind) {
  return kind.moves && !kind.of_vehicle && !kind.is_position;
}

ErrorSearch::ErrorSearch(Problem problem, const RobustBatchOptions& options,
                         double share)
    : problem_(std::move(problem)), options_(&options), share_(share) {
  if (options.last.empty()) return;
  with_last_ = problem_.decisions;
  for (std::size_t i = 0; i < problem_.decisions.size(); ++i) {
    if (IsLast(problem_.timeline.all_measurements()[i].sensor)) {
      problem_.decisions[i] = 0;
    }
  }
}

bool ErrorSearch::IsLast(int sensor) const {
  return std::ranges::count(options_->last, sensor) > 0;
}

bool ErrorSearch::NextIsLast() const {
  const SearchDecisions* decisions = options_->decisions;
  return decisions != nullptr && rounds_.size() < decisions->size() &&
         IsLast(
             static_cast<int>(SensorOf(*(*decisions)[rounds_.size()].front())));
}

ErrorSearch::Round ErrorSearch::Search(
    Problem* problem, const std::vector<State>& initial,
    const std::function<bool(int sensor)>& is_asked) {
  Ask();
  ErrorQuestion question = question_;
  const auto count = static_cast<int>(problem_.timeline.sensors().size());
  for (int i = 0; i < count; ++i) {
    if (!is_asked(i)) question.known.push_back(i);
  }
  Round round;
  round.tape = std::make_shared<const LinearTape>(RunLinearizedFilter(
      states_ ? *states_ : initial, problem, options_->callback));
  round.errors = FindReceiverErrors(*problem, *round.tape, question);
  ended_ |= std::ranges::any_of(round.errors, &ReceiverErrors::WasEnded);
  return round;
}

void ErrorSearch::Run(const std::vector<State>& initial) {
  const auto is_asked = [this](int sensor) {
    return !with_last_ || !IsLast(sensor);
  };
  while (HasNext()) {
    if (with_last_ && NextIsLast()) break;
    Round round = Search(&problem_, initial, is_asked);
    if (round.errors.empty()) break;
    const bool stands = round.best().Stands();
    Take(std::move(round));
    if (!stands) break;
  }
}

bool ErrorSearch::RunFrom(const std::function<bool(int sensor)>& is_asked,
                          const std::function<bool(int sensor)>& is_left_out,
                          const std::vector<State>& initial) {
  Problem without = Without(problem_, is_left_out);
  Round round = Search(&without, initial, is_asked);
  if (round.errors.empty() || !round.best().Stands()) return false;
  Take(std::move(round));
  Run(initial);
  return true;
}

bool ErrorSearch::RunFromVelocities(const std::vector<State>& initial) {
  const auto kind = [this](int sensor) -> const SensorKind& {
    const auto at = static_cast<std::size_t>(sensor);
    return *problem_.timeline.sensors()[at].kind;
  };
  velocities_first_ =
      RunFrom([&](int sensor) { return IsOfVelocity(kind(sensor)); },
              [&](int sensor) { return kind(sensor).is_position; }, initial);
  return velocities_first_;
}

bool ErrorSearch::RunFromOne(int sensor, const std::vector<int>& without,
                             const std::vector<State>& initial) {
  return RunFrom([&](int one) { return one == sensor; },
                 [&](int one) { return std::ranges::count(without, one) > 0; },
                 initial);
}

bool ErrorSearch::RunFromVehicle(const std::vector<int>& suspects,
                                 const std::vector<State>& initial) {
  if (!HasRoom()) return false;
  question_.of_vehicle = true;
  Round round = Search(&problem_, initial, [&suspects](int sensor) {
    return std::ranges::count(suspects, sensor) > 0;
  });
  question_.of_vehicle = false;
  if (round.errors.empty() || !round.best().Stands()) return false;
  Take(std::move(round));
  Run(initial);
  return true;
}

std::vector<int> ErrorSearch::SuspectsOfVehicle() const {
  constexpr double kFar = 5.0;            // sigma
  constexpr double kFalseAlarms = 0.001;  // of all sums
  if (rounds_.empty()) return {};
  std::set<int> contradicted;
  const std::vector<NormalisedInnovation> innovations =
      InnovationsOf(*rounds_.front().tape, problem_.timeline, {});
  for (const NormalisedInnovation& one : innovations) {
    if (one.rows.cwiseAbs().maxCoeff() > kFar) contradicted.insert(one.sensor);
  }
  for (const InnovationFigure& one :
       TestInnovations(innovations, kFalseAlarms)) {
    if (one.excess > 1.0) contradicted.insert(one.sensor);
  }
  const bool any_stands = rounds_.front().best().Stands();
  std::vector<int> suspects;
  const auto count = static_cast<int>(problem_.timeline.sensors().size());
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (problem_.timeline.sensors()[at].kind->of_vehicle &&
        (any_stands || contradicted.contains(i))) {
      suspects.push_back(i);
    }
  }
  return suspects;
}

void ErrorSearch::RunLast(const std::vector<State>& initial) {
  if (!with_last_) return;
  const GateDecisions with = *std::exchange(with_last_, std::nullopt);
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (IsLast(problem_.timeline.all_measurements()[i].sensor)) {
      problem_.decisions[i] = with[i];
    }
  }
  if (ended_) return;
  while (!rounds_.empty() && !rounds_.back().best().Stands()) {
    rounds_.pop_back();
  }
  if (HasRoom() && (options_->decisions == nullptr || NextIsLast())) {
    Round round = Search(&problem_, initial,
                         [this](int sensor) { return IsLast(sensor); });
    if (!round.errors.empty() && round.best().Stands()) Take(std::move(round));
  }
  Run(initial);
}

void ErrorSearch::RunAsDecided(const std::vector<State>& initial) {
  // Where all are searched, positions are among the first.
  const auto& sensors = problem_.timeline.sensors();
  const SearchDecisions& decisions = *options_->decisions;
  const auto begins_with = [&](const auto& is_asked) {
    return !decisions.empty() &&
           std::ranges::all_of(decisions.front(), [&](const auto& one) {
             return is_asked(*sensors[SensorOf(*one)].kind);
           });
  };
  if (begins_with([](const SensorKind& kind) { return kind.of_vehicle; })) {
    if (!RunFromVehicle({}, initial)) Run(initial);
  } else if (begins_with(IsOfVelocity)) {
    if (!RunFromVelocities(initial)) Run(initial);
  } else if (!BeganWithOne(initial)) {
    Run(initial);
  }
  RunLast(initial);
}

bool ErrorSearch::BeganWithOne(const std::vector<State>& initial) {
  const SearchDecisions& decisions = *options_->decisions;
  if (decisions.empty() || decisions.front().size() != 1) return false;
  const auto first = SensorOf(*decisions.front().front());
  std::vector<int> without;
  for (const DecidedErrors& round : decisions) {
    const auto sensor = SensorOf(*round.front());
    if (sensor != first) without.push_back(static_cast<int>(sensor));
  }
  return RunFromOne(static_cast<int>(first), without, initial);
}

bool ErrorSearch::MayBeOfAReceiver() const {
  const auto& sensors = problem_.timeline.sensors();
  const bool has_velocities = std::ranges::any_of(
      sensors, [](const Sensor& one) { return IsOfVelocity(*one.kind); });
  if (!has_velocities || question_.known.empty()) return false;
  const ReceiverErrors& first = rounds_.front().best();
  const bool changes = std::ranges::any_of(rounds_, [](const Round& one) {
    return one.best().Stands() && !one.best().ChangeTimes().empty();
  });
  return (changes && question_.known.size() > 1) || first.HasVelocitySteps() ||
         !first.Doubts().empty();
}

std::vector<int> ErrorSearch::SuspectsBeside() const {
  std::vector<int> others;
  if (question_.known.size() < 2) return others;
  const ReceiverErrors& first = rounds_.front().best();
  if (!KindOf(first).is_position ||
      (!first.HasVelocitySteps() && first.Doubts().empty())) {
    return others;
  }
  for (const Round& round : rounds_) {
    for (const ReceiverErrors& one : round.errors) {
      const bool is_suspect = one.Stands() && !KindOf(one).moves &&
                              std::ranges::count(others, one.sensor()) == 0;
      if (is_suspect) others.push_back(one.sensor());
    }
  }
  return others;
}

bool ErrorSearch::HasErrors(int sensor) const {
  return std::any_of(rounds_.begin(), rounds_.end(), [&](const Round& one) {
    return one.best().Stands() && one.best().sensor() == sensor;
  });
}

SearchDecisions ErrorSearch::Decisions() const {
  SearchDecisions all;
  for (const Round& round : rounds_) {
    all.emplace_back();
    for (const ReceiverErrors& one : round.errors) {
      all.back().push_back(one.Decisions());
    }
  }
  return all;
}

void ErrorSearch::Take(Round round) {
  const ReceiverErrors& best = round.best();
  if (best.Stands()) {
    best.Extend(&problem_);
    states_ = best.States(problem_.layout);
    question_.known.push_back(best.sensor());
  }
  rounds_.push_back(std::move(round));
}

bool ErrorSearch::HasNext() const {
  const SearchDecisions* decisions = options_->decisions;
  const bool wanted =
      decisions != nullptr ? rounds_.size() < decisions->size() : !ended_;
  return wanted && rounds_.size() < kMostRounds && HasRoom();
}

bool ErrorSearch::HasRoom() const {
  constexpr int kOwnStates = 6;
  return problem_.layout.parameter_count() + kOwnStates <= kMaxParameters &&
         problem_.layout.dim() + kOwnStates <= kMaxErrorDim;
}

void ErrorSearch::Ask() {
  const std::size_t i = rounds_.size();
  const bool decided =
      options_->decisions != nullptr && i < options_->decisions->size();
  question_.decided = decided ? &(*options_->decisions)[i] : nullptr;
  question_.until = options_->until;
  const auto round = static_cast<double>(searches_++);
  question_.share = share_ * std::exp2(-round);
  question_.go_on = [&go_on = options_->go_on, round](double fraction) {
    // A search takes half of what is left.
    return !go_on || go_on(1.0 - std::exp2(-(round + fraction)));
  };
}

const SensorKind& ErrorSearch::KindOf(const ReceiverErrors& errors) const {
  const auto sensor = static_cast<std::size_t>(errors.sensor());
  return *problem_.timeline.sensors()[sensor].kind;
}

}  // namespace hindsight
