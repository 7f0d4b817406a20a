#include "problems/error_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::size_t kMostRounds = 3;

/// Whether a step is followed by one that takes most of it back.
bool IsTakenBack(const ToldVelocityStep& step, const ToldVelocityStep& next) {
  constexpr double kLeft = 0.5;
  return next.step.begin <= step.step.end &&
         (step.size + next.size).norm() <
             kLeft * std::max(step.size.norm(), next.size.norm());
}

}  // namespace

ErrorSearch::ErrorSearch(Problem problem, const RobustBatchOptions& options,
                         double share)
    : problem_(std::move(problem)), options_(&options), share_(share) {
  if (options.met != nullptr) BeginFrom(*options.met);
  if (options.last.empty()) return;
  with_last_ = problem_.decisions;
  LeaveOut(options.last, problem_.timeline, &problem_.decisions);
}

void ErrorSearch::BeginFrom(const SearchDecisions& other) {
  for (const DecidedRound& round : other) {
    question_.met.insert(question_.met.end(), round.errors.begin(),
                         round.errors.end());
  }
}

bool ErrorSearch::IsLast(int sensor) const {
  return std::ranges::count(options_->last, sensor) > 0;
}

bool ErrorSearch::NextIsLast() const {
  const SearchDecisions* decisions = options_->decisions;
  return decisions != nullptr && rounds_.size() < decisions->size() &&
         IsLast(static_cast<int>(
             SensorOf(*(*decisions)[rounds_.size()].errors.front())));
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
  for (const ReceiverErrors& one : round.errors) {
    question_.met.push_back(one.Decisions());
  }
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
    if (stands && LacksOthers(round)) {
      Disbelieve(round.best().InWords(),
                 "there was no time to ask whether another sensor errs in its "
                 "place");
      break;
    }
    Take(std::move(round));
    if (!stands) break;
  }
}

bool ErrorSearch::LacksOthers(const Round& round) const {
  const ReceiverErrors& best = round.best();
  const bool is_sure =
      !best.IsUnfitted() && !best.HasVelocitySteps() && best.Doubts().empty();
  if (!ended_ || is_sure) return false;
  return with_last_.has_value() || round.errors.size() > 1 ||
         std::ranges::any_of(problem_.timeline.sensors(), [](const Sensor& s) {
           return s.kind->in_vehicle_axes;
         });
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

bool ErrorSearch::HasErrors(int sensor) const {
  return std::any_of(rounds_.begin(), rounds_.end(), [&](const Round& one) {
    return one.best().Stands() && one.best().sensor() == sensor;
  });
}

std::optional<Problem> ErrorSearch::Expected(Problem problem) const {
  bool any = false;
  for (const Round& round : rounds_) any |= round.best().Expect(&problem);
  if (!any) return std::nullopt;
  return problem;
}

SearchDecisions ErrorSearch::Decisions() const {
  SearchDecisions all;
  for (const Round& round : rounds_) {
    all.push_back({.without = round.without});
    for (const ReceiverErrors& one : round.errors) {
      all.back().errors.push_back(one.Decisions());
    }
  }
  return all;
}

void ErrorSearch::Take(Round round) {
  const ReceiverErrors& best = round.best();
  if (best.Stands()) {
    best.Extend(&problem_);
    for (const VelocityStep& step : CommonSteps(round)) {
      problem_.timeline.AddVelocityStep(step);
    }
    states_ = best.States(problem_.layout);
    question_.known.push_back(best.sensor());
  }
  rounds_.push_back(std::move(round));
}

std::vector<VelocityStep> ErrorSearch::CommonSteps(const Round& round) const {
  std::vector<ToldVelocityStep> common = round.best().VelocitySteps();
  if (common.empty()) return {};
  bool of_position = false;
  for (const ReceiverErrors& one : round.errors) {
    if (!one.Stands()) continue;
    of_position |= KindOf(one).is_position;
    const std::vector<ToldVelocityStep> own = one.VelocitySteps();
    std::erase_if(common, [&own](const ToldVelocityStep& told) {
      return std::ranges::none_of(own, [&told](const ToldVelocityStep& other) {
        return other.step.begin <= told.step.end &&
               other.step.end >= told.step.begin;
      });
    });
  }
  std::vector<VelocityStep> steps;
  if (!of_position ||
      std::ranges::adjacent_find(common, IsTakenBack) != common.end()) {
    return steps;
  }
  for (const ToldVelocityStep& told : common) steps.push_back(told.step);
  return steps;
}

bool ErrorSearch::HasNext() const {
  const SearchDecisions* decisions = options_->decisions;
  const bool wanted = decisions != nullptr ? rounds_.size() < decisions->size()
                                           : !ended_ && unbelieved_.empty();
  return wanted && rounds_.size() < kMostRounds && HasRoom();
}

bool ErrorSearch::HasRoom() const {
  constexpr int kOwnStates = 6;
  return HasRoomFor(problem_.layout, kOwnStates);
}

void ErrorSearch::Ask() {
  const std::size_t i = rounds_.size();
  const bool decided =
      options_->decisions != nullptr && i < options_->decisions->size();
  question_.decided = decided ? &(*options_->decisions)[i].errors : nullptr;
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
