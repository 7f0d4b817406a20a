#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

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

/// The searches of several sensors, in their order: each gets of effort and time an equal
/// part of what those before have left. Where the time did not suffice for the parameters
/// of several, which one fits best hangs on what its fit began from: none of these stands.
std::vector<std::unique_ptr<SensorFindings>> SearchAll(
    const Problem& problem, const LinearTape& tape,
    const ErrorQuestion& question, const std::vector<int>& sensors) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::unique_ptr<SensorFindings>> found;
  const auto count = static_cast<double>(sensors.size());
  double left = question.share;
  for (const int sensor : sensors) {
    const std::size_t parts = sensors.size() - found.size();
    const auto done = static_cast<double>(found.size());
    const auto now = Clock::now();
    const Clock::time_point until =
        now + (question.until - now) / static_cast<Clock::rep>(parts);
    const SearchLimits limits = {
        left / static_cast<double>(parts), [&, until](double fraction) {
          const bool goes_on =
              !question.go_on || question.go_on((done + fraction) / count);
          return goes_on && Clock::now() < until;
        }};
    found.push_back(std::make_unique<SensorFindings>(
        problem, tape, sensor, limits, MetOf(sensor, question.met)));
    left -= found.back()->spent;
  }
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
  // Positions, which take the most, come last and get what the others leave.
  std::ranges::reverse(sensors);
  for (auto& one : SearchAll(problem, tape, question, sensors)) {
    found.push_back(ReceiverErrors(std::move(one)));
  }
  std::ranges::reverse(found);
  std::ranges::stable_sort(found, std::greater<>(), &ReceiverErrors::log_gain);
  return found;
}

}  // namespace hindsight
