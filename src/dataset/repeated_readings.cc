#include "dataset/repeated_readings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/median.h"
#include "dataset/held_readings.h"
#include "dataset/resolution.h"

namespace hindsight {
namespace {

constexpr double kChance = 1e-6;
constexpr double kRounding = 1e-6;  // of a coordinate [m, m/s or uT]
constexpr double kDoubtfulShare = 1.0 / 2.0;
constexpr double kUnusableShare = 8.0 / 9.0;

long Rows(const HeldSeries& held) {
  long rows = 0;
  for (const HeldReading& reading : held) rows += reading.rows;
  return rows;
}

/// Of each coordinate.
Eigen::Vector4d ResolutionOf(const HeldSeries& held) {
  Eigen::Vector4d step;
  std::vector<double> values;
  values.reserve(held.size());
  for (int axis = 0; axis < 4; ++axis) {
    values.clear();
    for (const HeldReading& reading : held) {
      values.push_back(reading.reading.value(axis));
    }
    step(axis) =
        Resolution(values, {.absolute = kRounding}, ReadingCourse::kAnyhow);
  }
  return step;
}

long MedianRows(const HeldSeries& held) {
  std::vector<long> rows;
  for (const HeldReading& reading : held) rows.push_back(reading.rows);
  return Median(std::move(rows));
}

/// How far readings are apart that are `lag` rows apart and differ, as median
/// over the stream.
class UsualChange {
 public:
  explicit UsualChange(const HeldSeries& held) : held_(held) {
    std::size_t i = 0;
    for (const HeldReading& reading : held) {
      readings_.insert(readings_.end(), static_cast<std::size_t>(reading.rows),
                       i++);
    }
  }

  double Over(long lag) const {
    const auto [known, is_new] = over_.try_emplace(lag, 0.0);
    if (is_new) known->second = MedianOver(lag);
    return known->second;
  }

 private:
  double MedianOver(long lag) const {
    constexpr std::size_t kSamples = 1000;
    const std::size_t n =
        std::min(static_cast<std::size_t>(lag), readings_.size() / 2);
    const std::size_t stride = 1 + readings_.size() / kSamples;
    std::vector<double> changes;
    for (std::size_t i = 0; i + n < readings_.size(); i += stride) {
      const double change = (ValueOf(i + n) - ValueOf(i)).norm();
      if (change > 0.0) changes.push_back(change);
    }
    return Median(std::move(changes));
  }

  Eigen::Vector4d ValueOf(std::size_t row) const {
    return held_[readings_[row]].reading.value;
  }

  const HeldSeries& held_;
  std::vector<std::size_t> readings_;  ///< of each row
  mutable std::map<long, double> over_;
};

/// Whether a vehicle that stood still at the end of a run of equal positions
/// cannot have come to the next one.
bool IsUnderWay(const HeldReading& run, const HeldReading& next) {
  constexpr double kFastestStart = 10.0;           // [m/s^2]
  constexpr double kSigmas = 5.0 * 1.41421356237;  // of a difference
  if (!run.reading.position_sigma) return false;
  const Eigen::Vector3d jump =
      (next.reading.value - run.reading.value).head<3>();
  const double dt = next.t_begin - run.t_end;
  const double beyond = jump.norm() - 0.5 * kFastestStart * dt * dt;
  if (beyond <= 0.0) return false;
  const Eigen::Vector3d sigma = run.reading.position_sigma->cwiseMax(kRounding);
  return jump.cwiseQuotient(sigma).norm() * beyond / jump.norm() > kSigmas;
}

/// What tells a frozen stream from one that repeats by right.
class Repetitions {
 public:
  /// Runs of up to `habit` rows are told otherwise.
  Repetitions(const HeldSeries& held, bool is_speed, long habit)
      : held_(held),
        is_speed_(is_speed),
        habit_(habit),
        step_(kStepsOfResolution * ResolutionOf(held).array()),
        usual_(held),
        total_(static_cast<double>(Rows(held))) {
    for (const HeldReading& reading : held) {
      if (reading.rows > 1) rows_.push_back(reading.rows);
    }
    std::sort(rows_.begin(), rows_.end());
    const Eigen::Array4d finite = step_.isFinite().select(step_, 0.0);
    is_noisy_ = usual_.Over(1) > finite.matrix().norm();
  }

  /// Whether held[i], 0 < i + 1 < held.size(), repeats what goes on, as the
  /// jump at the end shows: at least half of the usual change over as many
  /// rows. A receiver that holds its position at rest does not jump.
  bool IsFrozen(std::size_t i) const {
    const HeldReading run = held_[i];
    if (run.rows < 2) return false;
    const Eigen::Array4d value = run.reading.value.array();
    if (is_speed_ && !(value.abs() > step_).any()) return false;
    if (!IsFar(i, i + 1) || Jump(i) < 0.5 * usual_.Over(run.rows)) return false;
    if (run.rows >= 3 && !IsByChance(rows_, run.rows)) return true;
    if (run.rows <= habit_) return false;
    return IsUnderWay(run, held_[i + 1]) || (i > 0 && IsTooLongForNoise(i));
  }

 private:
  double Jump(std::size_t i) const {
    return (held_[i + 1].reading.value - held_[i].reading.value).norm();
  }

  bool IsFar(std::size_t i, std::size_t j) const {
    return ((held_[j].reading.value - held_[i].reading.value).array().abs() >
            step_)
        .any();
  }

  bool IsTooLongForNoise(std::size_t i) const {
    const long length = held_[i].rows;
    if (!is_noisy_ || length < 4 || !IsFar(i, i - 1) ||
        held_[i].t_end - held_[i].t_begin < kLeastFrozen) {
      return false;
    }
    double repeats = 1.0;
    for (const long r : rows_) {
      if (2 * r >= length) break;
      repeats += static_cast<double>(r - 1);
    }
    const double share = std::min(1.0, repeats / total_);
    return total_ * std::pow(share, static_cast<double>(length - 1)) < kChance;
  }

  const HeldSeries& held_;
  bool is_speed_;
  long habit_;
  Eigen::Array4d step_;
  UsualChange usual_;
  double total_;            ///< rows
  std::vector<long> rows_;  ///< of runs of two and more, ascending
  bool is_noisy_ = false;
};

/// Spans over which a stream repeats one reading while what it measures goes
/// on.
std::vector<RepeatedRun> FrozenSpans(const AidingStream& stream,
                                     const HeldSeries& held, bool is_stale) {
  if (held.size() < 3) return {};
  const Repetitions repetitions(held, ReadsSpeed(stream.measurements.front()),
                                is_stale ? 2 * MedianRows(held) : 0);
  std::vector<RepeatedRun> spans;
  for (std::size_t i = 0; i + 1 < held.size(); ++i) {
    if (!repetitions.IsFrozen(i)) continue;
    spans.push_back({held[i].t_begin, held[i].t_end, held[i].rows});
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
  const std::string channel = worst.channel;
  std::string what =
      fmt::format("{} repeats one reading for {:.3g} s from {:.3f} s",
                  (channel.empty() ? name : channel + " of " + name), length,
                  worst.t_begin);
  if (runs.size() > 1)
    what += fmt::format(", and {} more times", runs.size() - 1);
  return {
      .grade = Grade::kDoubtful,
      .what = what,
      .value = length,
      .unit = "s",
      .t_begin = worst.t_begin,
      .t_end = worst.t_end,
      .causes = {"a sensor, driver or logger that repeats the last reading"},
      .remedies = {"the recording without these rows"}};
}

Evidence StaleEvidence(const std::string& name, double share) {
  const bool wrong = share >= kUnusableShare;
  const double limit = 100.0 * (wrong ? kUnusableShare : kDoubtfulShare);
  return {
      .rule = "stale_readings",
      .grade = wrong ? Grade::kUnusable : Grade::kDoubtful,
      .what = fmt::format("{} repeats the row before in {:.0f} % of its rows "
                          "while it moves (limit {:.0f})",
                          name, 100.0 * share, limit),
      .value = 100.0 * share,
      .limit = limit,
      .unit = "%",
      .causes = {"a logger that writes " + name +
                 " faster than it is measured"},
      .remedies = {"the rows of " + name + " at which it was measured, alone"}};
}

double ShareOf(const HeldSeries& held) {
  if (held.size() < 3) return 0.0;
  const Eigen::Array4d step = kStepsOfResolution * ResolutionOf(held).array();
  const long usual = 2 * MedianRows(held);
  const auto far = [&step](const HeldReading& a, const HeldReading& b) {
    return ((a.reading.value - b.reading.value).array().abs() > step).any();
  };
  long stale = 0;
  HeldReading before = held[0];
  HeldReading here = held[1];
  for (std::size_t i = 1; i + 1 < held.size(); ++i) {
    const HeldReading next = held[i + 1];
    if (here.rows <= usual && far(before, here) && far(next, here)) {
      stale += here.rows - 1;
    }
    before = std::exchange(here, next);
  }
  const long judged = Rows(held) - held.front().rows - held.back().rows;
  return static_cast<double>(stale) / static_cast<double>(judged);
}

}  // namespace

double StaleShare(const AidingStream& stream) {
  return ShareOf(HeldReadings(stream));
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
  if (!evidence.empty() && evidence.back().t_begin == dataset.imu.t_begin() &&
      evidence.back().t_end == dataset.imu.t_end()) {
    evidence.back().causes = {
        "a sensor that is not connected, or a column of something else"};
    evidence.back().remedies = {"the columns of the IMU"};
  }
  if (const double share = StaleImuShare(dataset.imu);
      share >= kDoubtfulShare) {
    evidence.push_back(StaleEvidence("imu", share));
  }
  for (const AidingStream& stream : dataset.streams) {
    const HeldSeries held = HeldReadings(stream);
    const double share = ShareOf(held);
    const bool is_stale = share >= kDoubtfulShare;
    add("frozen_stream", stream.sensor.name,
        FrozenSpans(stream, held, is_stale));
    if (is_stale) evidence.push_back(StaleEvidence(stream.sensor.name, share));
  }
  for (Evidence& found : evidence) found.is_cause = true;
  return evidence;
}

}  // namespace hindsight
