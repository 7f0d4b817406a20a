#include "imu/imu_stream.h"

#include <algorithm>
#include <utility>

#include "base/median.h"

namespace hindsight {
Evolution ImuNoise::GyroBiasEvolution() const {
  return Evolution::RandomWalk(gyro_bias_walk, gyro_bias_tau);
}

Evolution ImuNoise::AccelBiasEvolution() const {
  return Evolution::RandomWalk(accel_bias_walk, accel_bias_tau);
}

double MedianInterval(const ImuStream& stream) {
  if (stream.empty()) return 0.0;
  // A sample of the intervals is enough, and spares a day's copy.
  const std::size_t count = stream.samples.size() - 1;
  const std::size_t stride = std::max<std::size_t>(1, count / 10000);
  std::vector<double> intervals;
  for (std::size_t k = 1; k <= count; k += stride) {
    intervals.push_back(stream.samples[k].t - stream.samples[k - 1].t);
  }
  return Median(std::move(intervals));
}

double UsualInterval(const ImuStream& stream) {
  return stream.nominal_dt > 0.0 ? stream.nominal_dt : MedianInterval(stream);
}

std::vector<std::size_t> DropOuts(const ImuStream& stream) {
  if (stream.nominal_dt <= 0.0 || stream.empty()) return {};
  return FactsOf(stream)->drop_outs;
}

}  // namespace hindsight
