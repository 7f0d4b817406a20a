#ifndef HINDSIGHT_IMU_KNOWN_IMUS_H_
#define HINDSIGHT_IMU_KNOWN_IMUS_H_

#include <span>
#include <string_view>

#include "imu/imu_stream.h"

namespace hindsight {

/// What the maker says of an IMU's white noise; typical values, unless the source
/// says otherwise.
struct KnownImu {
  std::string_view name;
  double gyro_noise_density = 0.0;   ///< [rad/s/sqrt(Hz)]
  double accel_noise_density = 0.0;  ///< [m/s^2/sqrt(Hz)]
  std::string_view source;           ///< where it is written
};

std::span<const KnownImu> KnownImus();

/// nullptr where there is none of that name.
const KnownImu* FindKnownImu(std::string_view name);
/// Its white noise, with the walks that are usual beside it, of which makers say
/// nothing.
ImuNoise NoiseOf(const KnownImu& imu);

/// Walks of the biases that are usual beside white noise of that density, of
/// MEMS and fibre-optic units: 2e-3 and 4e-3 of it per second.
double UsualGyroBiasWalk(double noise_density);
double UsualAccelBiasWalk(double noise_density);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_KNOWN_IMUS_H_
