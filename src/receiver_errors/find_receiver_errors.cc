#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "measurements/sensor_kind.h"
#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/sensor_findings.h"

namespace hindsight {
namespace {

/// Whether a sensor tells a position, a velocity over the ground, a height, a
/// course, a heading or the magnetic field by itself.
bool IsAbsolute(const SensorKind& kind) {
  return kind.is_position || (kind.moves && !kind.of_vehicle) ||
         kind.is_height || kind.is_heading || kind.magnetic;
}

/// Those with a used measurement on the tape, of at most three rows; positions
/// come first. Absolute ones, or those in axes of the vehicle.
std::vector<int> SensorsInQuestion(const Timeline& timeline,
                                   const LinearTape& tape,
                                   bool in_vehicle_axes) {
  std::vector<int> rows(timeline.sensors().size(), 0);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!z.accepted || z.withheld) continue;
      int& most = rows[static_cast<std::size_t>(z.sensor)];
      most = std::max(most, static_cast<int>(z.residual.size()));
    }
  }
  std::vector<int> positions;
  std::vector<int> others;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == 0 || rows[i] > 3) continue;
    const SensorKind& kind = *timeline.sensors()[i].kind;
    if (in_vehicle_axes) {
      if (kind.in_vehicle_axes) others.push_back(static_cast<int>(i));
    } else if (kind.is_position) {
      positions.push_back(static_cast<int>(i));
    } else if (IsAbsolute(kind)) {
      others.push_back(static_cast<int>(i));
    }
  }
  positions.insert(positions.end(), others.begin(), others.end());
  return positions;
}

/// The errors of a fit, each once, without the steps of the IMU's velocity beside them, which
/// explain whatever the trajectory about which they were found had wrong.
MetHypotheses WithoutVelocitySteps(const MetHypotheses& fit) {
  MetHypotheses errors;
  for (Hypothesis h : fit) {
    for (ErrorStep& step : h.sequence) step = WithoutVelocityStep(step);
    const bool is_known = std::ranges::any_of(errors, [&h](const auto& other) {
      return other.sequence == h.sequence;
    });
    if (is_known || IsGoodThroughout(h.sequence)) continue;
    errors.push_back(std::move(h));
  }
  return errors;
}

std::vector<MetHypotheses> MetOf(int sensor, const DecidedErrors& met) {
  std::vector<MetHypotheses> all;
  for (const auto& one : met) {
    if (one->sensor != sensor) continue;
    for (const MetHypotheses& fit : one->met) {
      MetHypotheses errors = WithoutVelocitySteps(fit);
      if (!errors.empty()) all.push_back(std::move(errors));
    }
  }
  return all;
}

/// How often as many searches as there are threads go side by side until `searches` are
/// done.
std::chrono::steady_clock::rep TurnsOf(std::size_t searches) {
  const auto threads = static_cast<std::size_t>(ThreadCount());
  return static_cast<std::chrono::steady_clock::rep>((searches + threads - 1) /
                                                     threads);
}

/// Searches of several sensors, of which some go side by side.
class SensorSearches {
 public:
  SensorSearches(const Problem& problem, const LinearTape& tape,
                 const ErrorQuestion& question, const std::vector<int>& sensors)
      : problem_(problem),
        tape_(tape),
        question_(question),
        sensors_(sensors),
        found_(sensors.size()),
        done_(sensors.size(), 0.0) {}

  /// Those from `begin` to past `end`, each with such a share of the effort and the time
  /// of a turn; `later` others come after them. Returns what they have spent.
  double Run(std::size_t begin, std::size_t end, double share,
             std::size_t later) {
    std::atomic<std::size_t> begun = 0;
    ForRanges(end - begin, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) {
        const std::size_t to_come = end - begin - begun++;
        const auto now = Clock::now();
        Search(i, share,
               now + (question_.until - now) /
                         (TurnsOf(to_come) + TurnsOf(later)));
      }
    });
    double spent = 0.0;
    for (std::size_t i = begin; i < end; ++i) spent += found_[i]->spent;
    return spent;
  }

  std::vector<std::unique_ptr<SensorFindings>> Take() {
    return std::move(found_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void Search(std::size_t i, double share, Clock::time_point until) {
    const SearchLimits limits = {share, [this, i, until](double fraction) {
                                   return GoOn(i, fraction) &&
                                          Clock::now() < until;
                                 }};
    const int sensor = sensors_[i];
    found_[i] = std::make_unique<SensorFindings>(
        problem_, tape_, sensor, limits, MetOf(sensor, question_.met));
    const std::lock_guard<std::mutex> guard(mutex_);
    done_[i] = 1.0;
  }

  /// Whoever asks is told one at a time, of all searches together.
  bool GoOn(std::size_t i, double fraction) {
    if (!question_.go_on) return true;
    const std::lock_guard<std::mutex> guard(mutex_);
    done_[i] = fraction;
    return question_.go_on(std::accumulate(done_.begin(), done_.end(), 0.0) /
                           static_cast<double>(done_.size()));
  }

  const Problem& problem_;
  const LinearTape& tape_;
  const ErrorQuestion& question_;
  const std::vector<int>& sensors_;
  std::vector<std::unique_ptr<SensorFindings>> found_;
  std::mutex mutex_;
  std::vector<double> done_;
};

/// The searches of `sensors`, those of positions coming first there: the others side by
/// side, then these, which take the most and get what the others leave. Where the time did
/// not suffice for the parameters of several, which one fits best hangs on what its fit
/// began from: none of these stands.
std::vector<std::unique_ptr<SensorFindings>> SearchAll(
    const Problem& problem, const LinearTape& tape,
    const ErrorQuestion& question, const std::vector<int>& sensors) {
  const auto is_position = [&](int sensor) {
    return problem.timeline.sensors()[static_cast<std::size_t>(sensor)]
        .kind->is_position;
  };
  const auto count = static_cast<double>(sensors.size());
  const auto positions =
      static_cast<std::size_t>(std::ranges::count_if(sensors, is_position));
  SensorSearches searches(problem, tape, question, sensors);
  const double spent = searches.Run(positions, sensors.size(),
                                    question.share / count, positions);
  searches.Run(0, positions,
               (question.share - spent) / static_cast<double>(positions), 0);
  std::vector<std::unique_ptr<SensorFindings>> found = searches.Take();
  const auto is_unfitted = [](const auto& one) { return one->unfitted; };
  if (std::ranges::count_if(found, is_unfitted) > 1) {
    for (auto& one : found) {
      if (one->unfitted) one->Withdraw();
    }
  }
  return found;
}

}  // namespace

std::vector<ReceiverErrors> FindReceiverErrors(const Problem& problem,
                                               const LinearTape& tape,
                                               const ErrorQuestion& question) {
  std::vector<ReceiverErrors> found;
  if (question.decided != nullptr) {
    for (const auto& one : *question.decided) {
      auto again = FindingsAgain(*one, tape);
      if (again == nullptr) break;
      found.push_back(ReceiverErrors(std::move(again)));
    }
    if (!found.empty() && found.size() == question.decided->size()) {
      return found;
    }
    found.clear();
  }
  std::vector<int> sensors =
      SensorsInQuestion(problem.timeline, tape, question.in_vehicle_axes);
  std::erase_if(sensors, [&](int sensor) {
    return std::ranges::count(question.known, sensor) > 0;
  });
  for (auto& one : SearchAll(problem, tape, question, sensors)) {
    found.push_back(ReceiverErrors(std::move(one)));
  }
  std::ranges::stable_sort(found, std::greater<>(), &ReceiverErrors::log_gain);
  return found;
}

}  // namespace hindsight
