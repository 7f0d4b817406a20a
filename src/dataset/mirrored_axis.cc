#include "dataset/mirrored_axis.h"

#include <algorithm>
#include <limits>

#include "dataset/clock_search.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kNoFit = std::numeric_limits<double>::infinity();
constexpr int kAllGyros = 3;

/// The least misfit of a velocity in the vehicle's axes with an axis of both
/// triads turned round, or with all gyros.
double MisfitOfMirrored(const Dataset& dataset, int axis) {
  ImuStream imu = dataset.imu;
  for (ImuSample& sample : imu.samples) {
    if (axis == kAllGyros) {
      sample.gyro = -sample.gyro;
    } else {
      sample.gyro(axis) = -sample.gyro(axis);
      sample.accel(axis) = -sample.accel(axis);
    }
  }
  double misfit = kNoFit;
  for (const AidingStream& stream : dataset.streams) {
    const SensorKind* kind = stream.sensor.kind;
    if (kind != &DvlKind() && kind != &OdometerKind()) continue;
    const ClockSearch found = SearchClock(imu, dataset.initial, stream);
    if (!found.candidates.empty()) {
      misfit = std::min(misfit, found.candidates.front().misfit);
    }
  }
  return misfit;
}

}  // namespace

std::optional<MirroredAxis> FindMirroredAxis(const Dataset& dataset) {
  constexpr double kClear = 0.7;  // of the next best misfit
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

}  // namespace hindsight
