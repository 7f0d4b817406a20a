#ifndef HINDSIGHT_IMU_IMU_NOISE_H_
#define HINDSIGHT_IMU_IMU_NOISE_H_

#include <span>
#include <string_view>

#include "base/quantity.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// A value of ImuNoise that stands by itself, all of it: configuration, help, the
/// files of a simulated recording and the search for noise walk the list. Walks
/// and correlation times of the biases go together and are no part of it.
struct ImuNoiseValue {
  std::string_view name;  ///< key of `imu.noise`
  std::string_view help;
  Quantity quantity = Quantity::kRatio;
  const char* unit = "";  ///< in which it is written
  double unit_si = 1.0;
  double ImuNoise::*at = nullptr;
  bool needed = false;    ///< and greater than zero; others are 0 if absent
  bool searched = false;  ///< `check --noise` finds by what factor it is off
};

/// The list, in the order of documentation.
std::span<const ImuNoiseValue> ImuNoiseValues();

/// Variance of the gyros' white noise in a second, an axis, at the rate
/// |w| [rad^2/s]: density^2 + (noise per rate)^2 |w|^2.
double GyroWhiteNoise(const ImuNoise& noise, double squared_rate);
/// Of the accelerometers' [m^2/s^3].
double AccelWhiteNoise(const ImuNoise& noise);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_IMU_NOISE_H_
