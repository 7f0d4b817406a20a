#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <iterator>
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

/// What was met of a sensor, but for what needs steps of the IMU's velocity, which explain
/// whatever the trajectory about which they were found had wrong.
std::vector<Hypothesis> MetOf(int sensor, const DecidedErrors& met) {
  std::vector<Hypothesis> all;
  for (const auto& one : met) {
    if (one->sensor != sensor) continue;
    std::ranges::copy_if(one->met, std::back_inserter(all),
                         [](const Hypothesis& h) {
                           return CountVelocitySteps(h.sequence) == 0;
                         });
  }
  return all;
}

/// What several searches that go side by side tell of how far they are, and hear whether
/// they are to go on: one at a time, of all together.
class SharedProgress {
 public:
  SharedProgress(const SearchEffort::GoOn& go_on, std::size_t searches)
      : go_on_(go_on), done_(searches, 0.0) {}

  bool Update(std::size_t search, double fraction) {
    if (!go_on_) return true;
    const std::lock_guard<std::mutex> guard(mutex_);
    done_[search] = fraction;
    return go_on_(std::accumulate(done_.begin(), done_.end(), 0.0) /
                  static_cast<double>(done_.size()));
  }
  void End(std::size_t search) {
    const std::lock_guard<std::mutex> guard(mutex_);
    done_[search] = 1.0;
  }

 private:
  const SearchEffort::GoOn& go_on_;
  std::mutex mutex_;
  std::vector<double> done_;
};

/// How often as many searches as there are threads go side by side until `searches` are
/// done.
std::chrono::steady_clock::rep TurnsOf(std::size_t searches) {
  const auto threads = static_cast<std::size_t>(ThreadCount());
  return static_cast<std::chrono::steady_clock::rep>((searches + threads - 1) /
                                                     threads);
}

/// The searches of several sensors, of which those of positions come first in `sensors`
/// and are searched after the others, side by side within the two. Each gets an equal part
/// of the effort that is left, and of the time each turn of those that go side by side.
/// Where the time did not suffice
/// for the parameters of several, which one fits best hangs on what its fit began from:
/// none of these stands.
std::vector<std::unique_ptr<SensorFindings>> SearchAll(
    const Problem& problem, const LinearTape& tape,
    const ErrorQuestion& question, const std::vector<int>& sensors) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::unique_ptr<SensorFindings>> found(sensors.size());
  SharedProgress progress(question.go_on, sensors.size());
  const auto is_position = [&](int sensor) {
    return problem.timeline.sensors()[static_cast<std::size_t>(sensor)]
        .kind->is_position;
  };
  const auto positions = static_cast<std::size_t>(
      std::ranges::find_if_not(sensors, is_position) - sensors.begin());
  double left = question.share;
  const auto search_group = [&](std::size_t begin, std::size_t end) {
    const double share = left / static_cast<double>(end);
    std::atomic<std::size_t> begun = 0;
    ForRanges(end - begin, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) {
        const std::size_t to_come = end - begin - begun++;
        const auto now = Clock::now();
        const Clock::time_point until =
            now + (question.until - now) / (TurnsOf(to_come) + TurnsOf(begin));
        const SearchLimits limits = {share, [&, i, until](double fraction) {
                                       return progress.Update(i, fraction) &&
                                              Clock::now() < until;
                                     }};
        found[i] = std::make_unique<SensorFindings>(
            problem, tape, sensors[i], limits, MetOf(sensors[i], question.met));
        progress.End(i);
      }
    });
    for (std::size_t i = begin; i < end; ++i) left -= found[i]->spent;
  };
  // Positions, which take the most, get what the others leave.
  search_group(positions, sensors.size());
  search_group(0, positions);
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
