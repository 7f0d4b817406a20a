#include "alignment/clock_slack.h"

#include <algorithm>

#include "imu/mean_reading.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

double ClockSigma(const Dataset& dataset) {
  double sigma = 0.0;
  for (const AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->moves) {
      continue;
    }
    sigma = std::max(sigma, stream.sensor.time_offset_sigma.value_or(0.0));
  }
  return sigma;
}

Eigen::Vector3d TurnWithin(double seconds, const ImuStream& imu, double t,
                           const Eigen::Quaterniond& q_nb,
                           const Eigen::Vector3d& b_g) {
  constexpr double kBeside = 0.5;
  const Eigen::Vector3d w_b =
      MeanReading(imu, t - kBeside, t + kBeside).w_ib_b - b_g;
  return q_nb * (seconds * w_b);
}

}  // namespace hindsight
