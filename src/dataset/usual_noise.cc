#include "dataset/usual_noise.h"

#include <algorithm>

#include "base/units.h"
#include "imu/known_imus.h"

namespace hindsight {

UsualNoise UsualNoiseBeside(const ReadingNoise& noise) {
  constexpr double kLeastGyro = 0.005 * kDegree / 60.0;  // deg/sqrt(h)
  constexpr double kLeastAccel = 20.0 * kMicroG;
  constexpr double kConsumer = 0.001 * kDegree;  // density, deg/s/sqrt(Hz)
  UsualNoise usual;
  usual.gyro = std::max(noise.gyro, kLeastGyro);
  usual.accel = std::max(noise.accel, kLeastAccel);
  usual.gyro_quiet = std::max(noise.gyro_quiet, kLeastGyro);
  usual.accel_quiet = std::max(noise.accel_quiet, kLeastAccel);
  usual.gyro_bias_walk = UsualGyroBiasWalk(usual.gyro_quiet);
  usual.accel_bias_walk = UsualAccelBiasWalk(usual.accel_quiet);
  usual.consumer = usual.gyro_quiet > kConsumer;
  if (usual.consumer) {
    usual.gyro_bias_sigma = 1.0 * kDegree;
    usual.accel_bias_sigma = 50.0 * kMilliG;
  } else {
    usual.gyro_bias_sigma =
        std::clamp(40.0 * usual.gyro_quiet, 1e-5 * kDegree, 2.0 * kDegree);
    usual.accel_bias_sigma =
        std::clamp(40.0 * usual.accel_quiet, 0.1 * kMilliG, 50.0 * kMilliG);
  }
  return usual;
}

}  // namespace hindsight
