#include "dataset/timeline_builder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

// Over so long a turn may begin and a distance is still good to a millimetre.
constexpr double kIncrementSpacing = 0.2;

struct TimedMeasurement {
  double t = 0.0;
  const AidingStream* stream = nullptr;
  std::size_t row = 0;
  /// Of an increment: time of the node from which it counts.
  std::optional<double> start;

  Measurement z() const { return stream->measurements[row]; }
};

/// The count with which an increment begins, or nullptr for a measurement of
/// one instant.
const Odometer* AsIncrement(const Measurement& z) {
  const auto* odometer = std::get_if<Odometer>(&z.model);
  const bool increment =
      odometer != nullptr && odometer->form == Odometer::Form::kIncrements;
  return increment ? odometer : nullptr;
}

bool HasIncrements(const std::vector<TimedMeasurement>& timed) {
  return std::any_of(timed.begin(), timed.end(), [](const TimedMeasurement& m) {
    return m.start.has_value();
  });
}

std::vector<TimedMeasurement> MeasurementsInside(
    const Dataset& dataset, const TimelineOptions& options) {
  std::vector<TimedMeasurement> out;
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const AidingStream& stream = dataset.streams[i];
    const double offset = options.time_offsets.empty()
                              ? stream.sensor.time_offset
                              : options.time_offsets[i];
    for (std::size_t row = 0; row < stream.measurements.size(); ++row) {
      const Measurement z = stream.measurements[row];
      const double t = z.t + offset;
      TimedMeasurement timed{t, &stream, row, std::nullopt};
      if (const Odometer* increment = AsIncrement(z)) {
        timed.start = t - (z.t - increment->t_from);
      }
      if (timed.start.value_or(t) >= options.t_begin - kSameTime &&
          t <= options.t_end + kSameTime) {
        out.push_back(timed);
      }
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const TimedMeasurement& a, const TimedMeasurement& b) {
                     return a.t < b.t;
                   });
  return out;
}

/// Moves the measurements whose time offset is estimated to a node beside them,
/// if one is within a millisecond: the linear offset makes up for so little,
/// and an interval that short would leave the IMU's noise to rounding.
void ShareNodes(const Dataset& dataset, const std::vector<double>& required,
                std::vector<TimedMeasurement>* timed) {
  constexpr double kNear = 1e-3;
  if (std::none_of(dataset.streams.begin(), dataset.streams.end(),
                   [](const AidingStream& stream) {
                     return stream.sensor.time_offset_sigma.has_value();
                   })) {
    return;
  }
  std::set<double> nodes(required.begin(), required.end());
  const auto may_move = [](const TimedMeasurement& m) {
    return !m.start && m.stream->sensor.time_offset_sigma.has_value();
  };
  for (const TimedMeasurement& m : *timed) {
    if (may_move(m)) continue;
    nodes.insert(m.t);
    if (m.start) nodes.insert(*m.start);
  }
  for (TimedMeasurement& m : *timed) {
    if (!may_move(m)) continue;
    const auto after = nodes.lower_bound(m.t);
    double nearest = m.t + 2.0 * kNear;
    if (after != nodes.end()) nearest = *after;
    if (after != nodes.begin() &&
        m.t - *std::prev(after) < std::abs(nearest - m.t)) {
      nearest = *std::prev(after);
    }
    if (std::abs(nearest - m.t) <= kNear) {
      m.t = nearest;
    } else {
      nodes.insert(m.t);
    }
  }
  std::stable_sort(timed->begin(), timed->end(),
                   [](const TimedMeasurement& a, const TimedMeasurement& b) {
                     return a.t < b.t;
                   });
}

std::vector<IncrementStart> IncrementStarts(
    const std::vector<TimedMeasurement>& timed,
    const std::vector<double>& node_times) {
  std::vector<IncrementStart> starts;
  for (const TimedMeasurement& m : timed) {
    if (!m.start) continue;
    const auto node = std::lower_bound(node_times.begin(), node_times.end(),
                                       *m.start - kSameTime) -
                      node_times.begin();
    const Measurement z = m.z();
    starts.push_back({static_cast<int>(node), z.sensor, AsIncrement(z)->t_from,
                      std::nullopt});
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const IncrementStart& a, const IncrementStart& b) {
                     return a.node < b.node;
                   });
  return starts;
}

/// The required times and, between them, equal steps of at most `spacing`.
std::vector<double> NodeTimes(std::vector<double> required, double spacing) {
  constexpr double kMostNodes = 10e6;
  std::sort(required.begin(), required.end());
  const double steps_in_all = (required.back() - required.front()) / spacing;
  if (steps_in_all > kMostNodes) {
    throw InputError("nodes.max_spacing of " + std::to_string(spacing) +
                     " s makes " + std::to_string(std::llround(steps_in_all)) +
                     " nodes; expected at most 10000000");
  }
  std::vector<double> times;
  for (const double t : required) {
    if (times.empty()) {
      times.push_back(t);
      continue;
    }
    const double from = times.back();
    if (t - from <= kSameTime) continue;
    const int steps =
        std::max(1, static_cast<int>(std::ceil((t - from) / spacing - 1e-9)));
    for (int i = 1; i < steps; ++i) {
      times.push_back(from + (t - from) * i / steps);
    }
    times.push_back(t);
  }
  return times;
}

}  // namespace

std::optional<std::string> WhyNotNodes(const Dataset& dataset) {
  const double imu_interval = UsualInterval(dataset.imu);
  if (dataset.max_node_spacing >= imu_interval) return std::nullopt;
  return fmt::format(
      "is {:.4g} s, shorter than the IMU's sample interval of {:.4g} s",
      dataset.max_node_spacing, imu_interval);
}

Timeline BuildTimeline(const Dataset& dataset, const TimelineOptions& options) {
  if (const auto why = WhyNotNodes(dataset)) {
    throw InputError("nodes.max_spacing " + *why);
  }
  std::vector<TimedMeasurement> timed = MeasurementsInside(dataset, options);
  std::vector<double> required = {options.t_begin, options.t_end};
  for (const double t : options.extra_times) {
    if (t >= options.t_begin && t <= options.t_end) required.push_back(t);
  }
  ShareNodes(dataset, required, &timed);
  for (const TimedMeasurement& m : timed) {
    required.push_back(std::clamp(m.t, options.t_begin, options.t_end));
    if (m.start) required.push_back(*m.start);
  }
  const double spacing =
      HasIncrements(timed)
          ? std::min(dataset.max_node_spacing,
                     std::max(kIncrementSpacing, UsualInterval(dataset.imu)))
          : dataset.max_node_spacing;
  const std::vector<double> times = NodeTimes(std::move(required), spacing);

  std::vector<Node> nodes(times.size());
  std::vector<Measurement> measurements;
  measurements.reserve(timed.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    nodes[k].t = times[k];
    nodes[k].first_measurement = static_cast<int>(measurements.size());
    while (next < timed.size() &&
           (timed[next].t <= times[k] + kSameTime || k + 1 == times.size())) {
      measurements.push_back(timed[next++].z());
    }
    nodes[k].measurement_count =
        static_cast<int>(measurements.size()) - nodes[k].first_measurement;
  }
  std::vector<Sensor> sensors;
  for (const AidingStream& stream : dataset.streams) {
    sensors.push_back(stream.sensor);
  }
  Timeline timeline(std::move(nodes), std::move(measurements),
                    std::move(sensors), dataset.imu,
                    options.with_scale_jacobians);
  timeline.SetIncrementStarts(IncrementStarts(timed, times));
  return timeline;
}

}  // namespace hindsight
