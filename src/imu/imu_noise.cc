#include "imu/imu_noise.h"

#include <array>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr std::array kValues = {
    ImuNoiseValue{.name = "gyro",
                  .help = "white noise density",
                  .quantity = Quantity::kGyroNoiseDensity,
                  .unit = "deg/sqrt(h)",
                  .unit_si = kDegreePerSqrtHour,
                  .at = &ImuNoise::gyro_noise_density,
                  .needed = true,
                  .searched = true},
    ImuNoiseValue{.name = "accel",
                  .help = "white noise density",
                  .quantity = Quantity::kAccelNoiseDensity,
                  .unit = "m/s/sqrt(h)",
                  .unit_si = 1.0 / 60.0,
                  .at = &ImuNoise::accel_noise_density,
                  .needed = true,
                  .searched = true},
    ImuNoiseValue{.name = "gyro_per_rate",
                  .help = "noise density per rad/s",
                  .quantity = Quantity::kNoisePerRate,
                  .unit = "sqrt(s)",
                  .at = &ImuNoise::gyro_noise_per_rate},
};

}  // namespace

std::span<const ImuNoiseValue> ImuNoiseValues() { return kValues; }

double GyroWhiteNoise(const ImuNoise& noise, double squared_rate) {
  return noise.gyro_noise_density * noise.gyro_noise_density +
         noise.gyro_noise_per_rate * noise.gyro_noise_per_rate * squared_rate;
}

double AccelWhiteNoise(const ImuNoise& noise) {
  return noise.accel_noise_density * noise.accel_noise_density;
}

}  // namespace hindsight
