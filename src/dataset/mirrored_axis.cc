#include "dataset/mirrored_axis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dataset/clock_search.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kNoFit = std::numeric_limits<double>::infinity();
constexpr int kAllGyros = 3;
constexpr double kFiveSigmas = 5.0;
constexpr double kClear = 0.7;  // of the next best misfit

/// With an axis of both triads turned round, or with all gyros.
ImuStream Mirrored(ImuStream imu, int axis) {
  for (ImuSample& sample : imu.samples) {
    if (axis == kAllGyros) {
      sample.gyro = -sample.gyro;
    } else {
      sample.gyro(axis) = -sample.gyro(axis);
      sample.accel(axis) = -sample.accel(axis);
    }
  }
  return imu;
}

double LeastMisfit(const ImuStream& imu, const Dataset& dataset,
                   const AidingStream& stream, const OffsetRange& range = {}) {
  const ClockSearch found = SearchClock(imu, dataset.initial, stream, range);
  return found.candidates.empty() ? kNoFit : found.candidates.front().misfit;
}

/// Of the velocities in the vehicle's axes.
double MisfitOfMirrored(const Dataset& dataset, int axis) {
  const ImuStream imu = Mirrored(dataset.imu, axis);
  double misfit = kNoFit;
  for (const AidingStream& stream : dataset.streams) {
    const SensorKind* kind = stream.sensor.kind;
    if (kind != &DvlKind() && kind != &OdometerKind()) continue;
    misfit = std::min(misfit, LeastMisfit(imu, dataset, stream));
  }
  return misfit;
}

}  // namespace

std::optional<MirroredAxis> FindMirroredAxis(const Dataset& dataset) {
  MirroredAxis found = {0, kNoFit, kNoFit};
  for (int axis = 0; axis <= kAllGyros; ++axis) {
    const double misfit = MisfitOfMirrored(dataset, axis);
    if (misfit < found.misfit) {
      found = {axis, misfit, found.misfit};
    } else {
      found.next_misfit = std::min(found.next_misfit, misfit);
    }
  }
  if (!(found.misfit < kClear * found.next_misfit)) return std::nullopt;
  return found;
}

std::optional<OtherHand> FindOtherHand(const Dataset& dataset) {
  constexpr double kFits = 0.1;
  constexpr double kNear = 10.0;  // s
  constexpr int kAnyAxis = 1;
  for (const AidingStream& stream : dataset.streams) {
    const SensorKind* kind = stream.sensor.kind;
    if (!kind->is_position && !kind->is_velocity && !kind->moves &&
        kind != &SpeedCourseKind() && kind != &DvlKind() &&
        kind != &OdometerKind()) {
      continue;
    }
    OtherHand found = {stream.sensor.name};
    const double given = stream.sensor.time_offset;
    const OffsetRange near = {given - kNear, given + kNear};
    found.as_read = LeastMisfit(dataset.imu, dataset, stream, near);
    if (found.as_read < kFits) return std::nullopt;
    const ImuStream mirrored = Mirrored(dataset.imu, kAnyAxis);
    const ClockSearch search =
        SearchClock(mirrored, dataset.initial, stream, near);
    if (!search.candidates.empty()) {
      found.mirrored = search.candidates.front().misfit;
    }
    found.reversed =
        LeastMisfit(Mirrored(dataset.imu, kAllGyros), dataset, stream, near);
    const double best = std::min(found.mirrored, found.reversed);
    const bool chance = std::log(found.as_read / best) <
                        kFiveSigmas * 2.0 / std::sqrt(search.freedom);
    if (best < kClear * found.as_read && !chance) return found;
  }
  return std::nullopt;
}

std::string Describe(const OtherHand& found) {
  const bool mirrored = found.mirrored < kClear * found.reversed;
  const bool reversed = found.reversed < kClear * found.mirrored;
  return fmt::format(
      "{}: {} fits so (misfit {:.2g}) and not as they are read ({:.2g}); put a "
      "\"-\" before {} under `columns`",
      mirrored   ? "an axis is mirrored, of gyros and accelerometers"
      : reversed ? "the gyros have the other sign"
                 : "an axis is mirrored, or the gyros have the other sign",
      found.stream, std::min(found.mirrored, found.reversed), found.as_read,
      reversed ? "their columns"
               : "both columns of the axis that is drawn the other way");
}

}  // namespace hindsight
