#include "dataset/reading_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hindsight {
namespace {

/// Ten seconds in a hundred are quiet; all the while the IMU swings slowly.
TEST(ReadingNoise, IsWhatWasDrawnWhateverTheMotion) {
  constexpr double kDt = 0.01;
  constexpr double kGyro = 2e-3;
  constexpr double kAccel = 3e-2;
  Random random(7301);
  ImuStream imu;
  for (int k = 0; k < 10000; ++k) {
    const double t = k * kDt;
    const double loud = t < 20.0 ? 0.2 : 1.0;
    ImuSample sample;
    sample.t = t;
    sample.gyro = loud * kGyro / std::sqrt(kDt) * random.NormalVector3();
    sample.accel = loud * kAccel / std::sqrt(kDt) * random.NormalVector3();
    sample.gyro.x() += 0.5 * std::sin(t);
    sample.accel.y() += 3.0 * std::cos(t);
    imu.samples.push_back(sample);
  }
  const ReadingNoise noise = NoiseOfReadings(imu);
  const double all = std::sqrt(0.8 + 0.2 * 0.2 * 0.2);
  EXPECT_NEAR(noise.gyro, all * kGyro, 0.03 * kGyro);
  EXPECT_NEAR(noise.accel, all * kAccel, 0.03 * kAccel);
  EXPECT_NEAR(noise.gyro_quiet, 0.2 * kGyro, 0.03 * kGyro);
  EXPECT_NEAR(noise.accel_quiet, 0.2 * kAccel, 0.03 * kAccel);
}

}  // namespace
}  // namespace hindsight
