#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dataset/dataset.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

void Withhold(const Withholding& withholding, const Dataset& dataset, int index,
              AidingStream* stream, std::vector<Outage>* outages) {
  const double offset = stream->sensor.time_offset;
  MeasurementSeries& measurements = stream->measurements;
  // Fixes beyond the IMU's record are predicted by nobody.
  const auto usable = [&](const Measurement& z) {
    const double t = z.t + offset;
    return dataset.imu.empty() ||
           (t >= dataset.imu.t_begin() && t <= dataset.imu.t_end());
  };
  std::size_t next = 0;
  while (next < measurements.size() && !usable(measurements[next])) ++next;
  if (next == measurements.size()) return;
  std::size_t last = measurements.size() - 1;
  while (!usable(measurements[last])) --last;
  const auto time = [&](std::size_t i) { return measurements[i].t + offset; };
  const double first_fix = time(next);
  const double last_fix = time(last);
  const double start = withholding.from ? time(0) + *withholding.from
                                        : first_fix + withholding.every;
  constexpr double kMostOutages = 100000.0;
  const double count = (last_fix - start) / withholding.every;
  if (count > kMostOutages) {
    throw InputError(fmt::format(
        "every {:.6g} s makes {:.3g} outages of '{}'; expected at most "
        "{:.0f}",
        withholding.every, count, stream->sensor.name, kMostOutages));
  }
  for (int k = 0;; ++k) {
    const Outage outage{index, start + k * withholding.every,
                        start + k * withholding.every + withholding.length};
    if (outage.t_end > last_fix) return;
    if (outage.t_begin < first_fix) continue;
    while (next <= last && time(next) < outage.t_begin) ++next;
    for (; next <= last && time(next) < outage.t_end; ++next) {
      measurements.Edit(next, [](Measurement& z) { z.withheld = true; });
    }
    outages->push_back(outage);
  }
}

}  // namespace

void ApplyWithholding(Dataset* dataset) {
  dataset->outages.clear();
  for (AidingStream& stream : dataset->streams) {
    for (Measurement& z : stream.measurements.Edited()) z.withheld = false;
  }
  for (const Withholding& withholding : dataset->withholdings) {
    bool found = false;
    for (std::size_t i = 0; i < dataset->streams.size(); ++i) {
      AidingStream& stream = dataset->streams[i];
      const SensorKind& kind = *stream.sensor.kind;
      if (withholding.sensor != stream.sensor.name &&
          withholding.sensor != kind.name &&
          withholding.sensor != kind.family) {
        continue;
      }
      found = true;
      Withhold(withholding, *dataset, static_cast<int>(i), &stream,
               &dataset->outages);
    }
    if (found) continue;
    std::string known;
    for (const AidingStream& stream : dataset->streams) {
      known += (known.empty() ? "" : ", ") + stream.sensor.name;
    }
    throw InputError("'" + withholding.sensor +
                     "' is no aiding stream to withhold; expected a type or "
                     "one of " +
                     (known.empty() ? "none: there is no aiding" : known));
  }
}

}  // namespace hindsight
