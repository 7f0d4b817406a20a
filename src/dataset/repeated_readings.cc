#include "dataset/repeated_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr double kLeastFrozen = 0.1;  // [s]
constexpr double kChance = 1e-6;
/// Runs shorter than this share of the one in question tell what is usual.
constexpr long kUsualShare = 2;
constexpr double kStepsOfResolution = 4.0;
constexpr double kRounding = 1e-6;       // of a coordinate [m or m/s]
constexpr double kEarthRadius = 6.37e6;  // [m], for lengths of degrees
constexpr double kDoubtfulShare = 1.0 / 2.0;
constexpr double kUnusableShare = 8.0 / 9.0;

/// Runs of two and more equal samples.
std::vector<RepeatedRun> RunsOf(const ImuStream& imu) {
  std::vector<RepeatedRun> runs;
  bool open = false;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample& a = imu.samples[k - 1];
    const ImuSample& b = imu.samples[k];
    if (a.gyro != b.gyro || a.accel != b.accel) {
      open = false;
      continue;
    }
    if (!open) runs.push_back({a.t, a.t, 1});
    open = true;
    runs.back().t_end = b.t;
    ++runs.back().rows;
  }
  return runs;
}

/// Whether chance makes a run of so many rows, among runs of which those
/// shorter than half of it tell how likely they go on, which they do if the
/// noise is at least a fifth of a step of the resolution. `rows` ascends.
bool IsByChance(const std::vector<long>& rows, long length) {
  double repeats = 1.0;  // a repetition that ends, so that none is certain
  double ends = 1.0;
  for (const long r : rows) {
    if (kUsualShare * r >= length) break;
    repeats += static_cast<double>(r - 2);
    ends += 1.0;
  }
  const double go_on = repeats / (repeats + ends);
  const double expected = static_cast<double>(rows.size()) *
                          std::pow(go_on, static_cast<double>(length - 2));
  return expected > kChance;
}

using Vectors = std::vector<Eigen::Vector3d>;

/// Positions as metres north, east and up, or velocities; empty for a stream of
/// another kind.
Vectors ReadingsOf(const AidingStream& stream) {
  Vectors readings;
  double cosine = 1.0;
  for (const Measurement& z : stream.measurements) {
    if (const auto* position = std::get_if<PositionFix>(&z.model)) {
      const Geodetic place = GeodeticFromEcef(position->p_e);
      if (readings.empty()) cosine = std::cos(place.latitude);
      readings.emplace_back(kEarthRadius * place.latitude,
                            kEarthRadius * cosine * place.longitude,
                            place.height);
    } else if (const auto* velocity = std::get_if<VelocityFix>(&z.model)) {
      readings.push_back(velocity->v_n);
    }
  }
  return readings;
}

struct HeldReading {
  Eigen::Vector3d value;
  long rows = 1;
  std::size_t first = 0;  ///< row
};

std::vector<HeldReading> HeldReadings(const Vectors& readings) {
  std::vector<HeldReading> held;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (!held.empty() && held.back().value == readings[i]) {
      ++held.back().rows;
    } else {
      held.push_back({readings[i], 1, i});
    }
  }
  return held;
}

/// The differences of neighbours in order of size, ascending.
std::vector<double> Gaps(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double gap = values[i] - values[i - 1];
    if (gap > kRounding) gaps.push_back(gap);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

/// Of each coordinate the step that all its differences are multiples of, or
/// less: the least gap between values, or between the sizes of gaps, as values
/// that only grow may all be far from each other.
Eigen::Vector3d Resolution(const std::vector<HeldReading>& held) {
  Eigen::Vector3d least =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::vector<double> values(held.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < held.size(); ++i) {
      values[i] = held[i].value(axis);
    }
    const std::vector<double> gaps = Gaps(values);
    for (const auto& candidates : {gaps, Gaps(gaps)}) {
      if (candidates.empty()) continue;
      least(axis) = std::min(least(axis), candidates.front());
    }
  }
  return least;
}

long MedianRows(std::vector<HeldReading> held) {
  const auto middle =
      held.begin() + static_cast<std::ptrdiff_t>(held.size() / 2);
  std::nth_element(held.begin(), middle, held.end(),
                   [](const HeldReading& a, const HeldReading& b) {
                     return a.rows < b.rows;
                   });
  return middle->rows;
}

/// The median distance of two readings in a row that differ.
double MedianStep(const std::vector<HeldReading>& held) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < held.size(); ++i) {
    steps.push_back((held[i].value - held[i - 1].value).norm());
  }
  const auto middle =
      steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Spans over which a stream repeats one reading while the vehicle goes on, as
/// the jump at the end shows: at least half of what as many usual steps make. A
/// receiver that holds its position at rest does not jump.
std::vector<RepeatedRun> FrozenSpans(const AidingStream& stream) {
  const std::vector<HeldReading> held = HeldReadings(ReadingsOf(stream));
  if (held.size() < 3) return {};
  const Eigen::Array3d resolution = Resolution(held).array();
  const double usual = MedianStep(held);
  std::vector<long> rows;
  for (const HeldReading& reading : held) {
    if (reading.rows > 1) rows.push_back(reading.rows);
  }
  std::sort(rows.begin(), rows.end());
  std::vector<RepeatedRun> spans;
  for (std::size_t i = 0; i + 1 < held.size(); ++i) {
    const Eigen::Vector3d jump = held[i + 1].value - held[i].value;
    const long count = held[i].rows;
    if (count < 3 || jump.norm() < 0.5 * static_cast<double>(count) * usual ||
        !(jump.array().abs() > kStepsOfResolution * resolution).any() ||
        IsByChance(rows, count)) {
      continue;
    }
    const auto last = held[i].first + static_cast<std::size_t>(count) - 1;
    spans.push_back({stream.measurements[held[i].first].t,
                     stream.measurements[last].t, count});
  }
  return spans;
}

Evidence FrozenEvidence(const std::string& name,
                        const std::vector<RepeatedRun>& runs) {
  const RepeatedRun& worst = *std::max_element(
      runs.begin(), runs.end(), [](const RepeatedRun& a, const RepeatedRun& b) {
        return a.t_end - a.t_begin < b.t_end - b.t_begin;
      });
  const double length = worst.t_end - worst.t_begin;
  std::string what = Format("%s repeats one reading for %.3g s from %.3f s",
                            name.c_str(), length, worst.t_begin);
  if (runs.size() > 1) what += Format(", and %zu more times", runs.size() - 1);
  return {.grade = Grade::kDoubtful,
          .what = what,
          .value = length,
          .unit = "s",
          .t_begin = worst.t_begin,
          .t_end = worst.t_end,
          .causes = {"a logger or driver that repeats the last reading"},
          .remedies = {"the recording without these rows"}};
}

Evidence StaleEvidence(const std::string& name, double share) {
  const bool wrong = share >= kUnusableShare;
  const double limit = 100.0 * (wrong ? kUnusableShare : kDoubtfulShare);
  return {
      .rule = "stale_readings",
      .grade = wrong ? Grade::kUnusable : Grade::kDoubtful,
      .what = Format("%s repeats the row before in %.0f %% of its rows "
                     "while it moves (limit %.0f)",
                     name.c_str(), 100.0 * share, limit),
      .value = 100.0 * share,
      .limit = limit,
      .unit = "%",
      .causes = {"a logger that writes " + name +
                 " faster than it is measured"},
      .remedies = {"the rows of " + name + " at which it was measured, alone"}};
}

}  // namespace

std::vector<RepeatedRun> FindFrozenImu(const ImuStream& imu) {
  std::vector<RepeatedRun> runs = RunsOf(imu);
  std::vector<long> rows;
  for (const RepeatedRun& run : runs) rows.push_back(run.rows);
  std::sort(rows.begin(), rows.end());
  std::erase_if(runs, [&rows](const RepeatedRun& run) {
    return run.t_end - run.t_begin < kLeastFrozen || IsByChance(rows, run.rows);
  });
  return runs;
}

double StaleShare(const AidingStream& stream) {
  const Vectors readings = ReadingsOf(stream);
  const std::vector<HeldReading> held = HeldReadings(readings);
  if (held.size() < 3) return 0.0;
  const Eigen::Array3d step = kStepsOfResolution * Resolution(held).array();
  const long usual = 2 * MedianRows(held);
  long stale = 0;
  for (std::size_t i = 1; i + 1 < held.size(); ++i) {
    const auto far = [&](std::size_t j) {
      return ((held[j].value - held[i].value).array().abs() > step).any();
    };
    if (held[i].rows <= usual && far(i - 1) && far(i + 1)) {
      stale += held[i].rows - 1;
    }
  }
  return static_cast<double>(stale) / static_cast<double>(readings.size());
}

std::vector<Evidence> FindRepeatedReadings(const Dataset& dataset, double from,
                                           double to) {
  std::vector<Evidence> evidence;
  const auto add = [&](const char* rule, const std::string& name,
                       std::vector<RepeatedRun> runs) {
    std::erase_if(runs, [from, to](const RepeatedRun& run) {
      return run.t_end < from || run.t_begin > to;
    });
    if (runs.empty()) return;
    evidence.push_back(FrozenEvidence(name, runs));
    evidence.back().rule = rule;
  };
  add("frozen_imu", "imu", FindFrozenImu(dataset.imu));
  for (const AidingStream& stream : dataset.streams) {
    add("frozen_stream", stream.sensor.name, FrozenSpans(stream));
    const double share = StaleShare(stream);
    if (share < kDoubtfulShare) continue;
    evidence.push_back(StaleEvidence(stream.sensor.name, share));
  }
  return evidence;
}

}  // namespace hindsight
