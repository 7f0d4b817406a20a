#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "filters/rts.h"
#include "problems/error_search.h"

namespace hindsight {
namespace {

/// A sensor that is searched in several rounds may say the same in each.
template <typename T, typename Words>
void AddOnce(T one, Words words, std::vector<T>* all) {
  const auto same = [&](const T& other) {
    return std::invoke(words, other) == std::invoke(words, one);
  };
  if (std::ranges::none_of(*all, same)) all->push_back(std::move(one));
}

}  // namespace

std::string ErrorSearch::InWords() const {
  std::string words;
  for (const Round& round : rounds_) {
    if (!round.best().Stands()) break;
    words += (words.empty() ? "" : "; ") + round.best().InWords();
  }
  return words;
}

void ErrorSearch::TakeSizes(const std::vector<State>& states) {
  for (Round& round : rounds_) {
    if (!round.best().Stands()) break;
    round.errors.front().TakeSizes(problem_.layout, states);
  }
}

void ErrorSearch::Tell(RobustBatchResult* result) const {
  result->trust.resize(problem_.timeline.sensors().size());
  const double imu_scale = LeastImuScale();
  double most = 0.0;
  for (std::size_t i = 0; i < rounds_.size(); ++i) {
    const ReceiverErrors& best = rounds_[i].best();
    // The last round may have found nothing: then it tells what was refused.
    if (!best.Stands() && i > 0) break;
    TellNotes(rounds_[i], imu_scale, result);
    if (!best.Stands()) break;
    // What else velocities may have done without the positions is farther off than
    // with them.
    const bool is_without_positions =
        !rounds_[i].without.empty() && IsOfVelocity(KindOf(best));
    // What stands beside these errors has not been sought beside another's.
    const bool is_last =
        i + 1 == rounds_.size() || !rounds_[i + 1].best().Stands();
    const Worth worth = is_without_positions ? Worth::kNothing
                        : is_last            ? Worth::kMean
                                             : Worth::kCovariance;
    if (!is_without_positions) {
      std::optional<Evidence> doubt = best.Average(
          problem_.layout, &result->batch.states, &result->batch.P);
      if (doubt) result->doubts.push_back(std::move(*doubt));
    }
    if (best.log_gain() > most) result->modes = best.Modes();
    most = std::max(most, best.log_gain());
    for (BoundedValue& one : best.Bounded()) {
      result->bounded.push_back(std::move(one));
    }
    result->trust[static_cast<std::size_t>(best.sensor())] = best.Trust();
    TellRivals(rounds_[i], worth, result);
  }
  TellVelocitySteps(result);
  TellUndecided(result);
  if (unbelieved_.empty()) return;
  result->notes.push_back(unbelieved_);
}

void ErrorSearch::Disbelieve(const std::string& words, const std::string& why) {
  unbelieved_ = words + ": not believed, as " + why;
}

void ErrorSearch::TellVelocitySteps(RobustBatchResult* result) const {
  const std::vector<VelocityStep>& steps = problem_.timeline.velocity_steps();
  if (steps.empty()) return;
  std::string when;
  for (const VelocityStep& step : steps) {
    when += fmt::format("{}{:.1f} to {:.1f} s", when.empty() ? "" : ", ",
                        step.begin, step.end);
  }
  result->doubts.push_back(
      {.grade = Grade::kDoubtful,
       .what = "the velocity of the IMU steps (" + when +
               "), or all that contradicts it errs alike from there on",
       .value = static_cast<double>(steps.size()),
       .unit = "1",
       .causes = {"samples that are lost, or beyond the range of the IMU",
                  "receivers that drift"},
       .remedies = {"another sensor of positions or velocities"}});
}

void ErrorSearch::TellUndecided(RobustBatchResult* result) const {
  for (const Round& round : rounds_) {
    std::optional<CovarianceSeries> P;
    for (const ReceiverErrors& one : round.errors) {
      // Others are asked again in the next round.
      const bool asked = &one == &round.best() || &round == &rounds_.back();
      if (!asked || !one.IsUndecided()) continue;
      if (!P) P = SmoothRts(*round.tape).P;
      std::optional<Evidence> doubt = one.DoubtOfNoise(*P);
      if (doubt) AddOnce(*std::move(doubt), &Evidence::what, &result->doubts);
    }
  }
}

double ErrorSearch::LeastImuScale() const {
  double least = 1.0;
  for (const Round& round : rounds_) {
    if (!round.best().Stands()) break;
    least = std::min(least, round.best().imu_scale());
  }
  return least;
}

void ErrorSearch::TellNotes(const Round& round, double imu_scale,
                            RobustBatchResult* result) {
  for (const ReceiverErrors& one : round.errors) {
    const bool best = &one == &round.best();
    if (best || !round.best().Stands()) {
      for (std::string& note : one.Notes(result->batch.P)) {
        AddOnce(std::move(note), std::identity(), &result->notes);
      }
    }
    for (Evidence& doubt : one.Doubts(imu_scale)) {
      if (best || doubt.value == std::nullopt) {
        AddOnce(std::move(doubt), &Evidence::what, &result->doubts);
      }
    }
  }
}

void ErrorSearch::TellRivals(const Round& round, Worth worth,
                             RobustBatchResult* result) {
  const ReceiverErrors& best = round.best();
  std::vector<RivalSensor> rivals;
  double odds = 1.0;  // of all beside the best
  for (std::size_t i = 1; i < round.errors.size(); ++i) {
    const ReceiverErrors& other = round.errors[i];
    const double behind = best.log_gain() - other.log_gain();
    if (!other.Stands() || behind >= kSureLogOdds) continue;
    odds += std::exp(-behind);
    if (best.IsApart(other, result->batch.P)) {
      rivals.push_back({&other, std::exp(-behind)});
    }
  }
  if (rivals.empty()) return;
  for (RivalSensor& one : rivals) one.probability /= odds;
  const bool is_mean =
      worth != Worth::kNothing &&
      best.AverageWith(rivals, result->problem.layout,
                       worth == Worth::kMean ? &result->batch.states : nullptr,
                       &result->batch.P);
  std::string names = best.name();
  std::string words = ": " + best.InWords();
  double farthest = 0.0;
  for (const RivalSensor& one : rivals) {
    const std::string likely = FormatProbability(one.probability);
    const double distance = std::sqrt(best.MeanSquareDistanceTo(*one.errors));
    farthest = std::max(farthest, distance);
    names += fmt::format(", or {} likely {}", likely, one.errors->name());
    words += "; " + one.errors->InWords();
    result->notes.push_back(fmt::format(
        "or, {} likely and {:.3g} m away in the root mean square{}: {}", likely,
        distance,
        is_mean ? " from that, between which the result is the mean" : "",
        one.errors->InWords()));
  }
  if (is_mean) {
    words += ": the result is the mean, weighed by their probabilities";
  }
  result->doubts.push_back(
      {.grade = Grade::kDoubtful,
       .what = "which sensor errs cannot be told: " + names + words,
       .value = farthest,
       .unit = "m",
       .causes = {"sensors that contradict each other where the IMU cannot "
                  "tell which is right"},
       .remedies = {"'--without', which leaves one of them out"}});
}

}  // namespace hindsight
