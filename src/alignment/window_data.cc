#include "alignment/window_data.h"

#include <algorithm>
#include <variant>

namespace hindsight {
namespace {

/// Measurements that need no calibration found elsewhere first.
bool IsPlain(const MeasurementModel& model) {
  return std::holds_alternative<PositionFix>(model) ||
         std::holds_alternative<VelocityFix>(model) ||
         std::holds_alternative<HeightFix>(model) ||
         std::holds_alternative<SpeedCourse>(model) ||
         std::holds_alternative<ZeroVelocity>(model) ||
         std::holds_alternative<ZeroAngularRate>(model);
}

}  // namespace

Dataset CutOut(const AlignmentInput& input, double t_end) {
  const Dataset& whole = input.dataset;
  const double t_begin = input.t;
  Dataset cut;
  cut.imu = ImuStream{whole.imu.kind,
                      {},
                      whole.imu.noise,
                      whole.imu.max_gap,
                      whole.imu.nominal_dt};
  const auto before = [](const ImuSample& sample, double t) {
    return sample.t < t;
  };
  const auto& samples = whole.imu.samples;
  auto first =
      std::lower_bound(samples.begin(), samples.end(), t_begin, before);
  auto last = std::lower_bound(first, samples.end(), t_end, before);
  first -= std::min<std::ptrdiff_t>(2, first - samples.begin());
  last += std::min<std::ptrdiff_t>(2, samples.end() - last);
  cut.imu.samples.assign(first, last);
  cut.gyro_scale_sigma = whole.gyro_scale_sigma;
  cut.accel_scale_sigma = whole.accel_scale_sigma;
  cut.max_node_spacing = whole.max_node_spacing;
  cut.initial = whole.initial;
  const GyroBiasPrior gyro = GyroBiasBefore(input);
  cut.initial.gyro_bias = gyro.b_g;
  cut.initial.gyro_bias_sigma = gyro.sigma;
  for (const AidingStream& stream : whole.streams) {
    AidingStream& kept = cut.streams.emplace_back();
    kept.sensor = stream.sensor;
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      if (t >= t_begin && t <= t_end && !z.withheld && IsPlain(z.model)) {
        kept.measurements.push_back(z);
      }
    }
    if (!kept.measurements.empty()) continue;
    // Without measurements it needs no states.
    kept.sensor = Sensor();
    kept.sensor.name = stream.sensor.name;
  }
  return cut;
}

}  // namespace hindsight
