#ifndef HINDSIGHT_DATASET_READING_NOISE_H_
#define HINDSIGHT_DATASET_READING_NOISE_H_

#include "imu/imu_stream.h"

namespace hindsight {

/// White noise as an IMU's readings show it by themselves, vibration included.
struct ReadingNoise {
  double gyro = 0.0;         ///< over the record [rad/s/sqrt(Hz)]
  double accel = 0.0;        ///< [m/s^2/sqrt(Hz)]
  double gyro_quiet = 0.0;   ///< where it scatters least
  double accel_quiet = 0.0;  ///< likewise
};

/// From second differences x(k-1) - 2 x(k) + x(k+1), in which motion that lasts
/// longer than a few samples is small and white noise of variance s^2 has
/// 6 s^2: over windows of a second, the root mean square of all windows and that
/// of the quietest tenth, an axis. A stream shorter than a second has none.
ReadingNoise NoiseOfReadings(const ImuStream& imu);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_READING_NOISE_H_
