#ifndef HINDSIGHT_DATASET_USUAL_NOISE_H_
#define HINDSIGHT_DATASET_USUAL_NOISE_H_

#include "dataset/reading_noise.h"

namespace hindsight {

/// Noise and biases that an IMU usually has beside the white noise of its
/// readings.
struct UsualNoise {
  double gyro = 0.0;        ///< white, vibration included [rad/s/sqrt(Hz)]
  double accel = 0.0;       ///< [m/s^2/sqrt(Hz)]
  double gyro_quiet = 0.0;  ///< where quiet
  double accel_quiet = 0.0;
  double gyro_bias_walk = 0.0;    ///< [rad/s^2/sqrt(Hz)]
  double accel_bias_walk = 0.0;   ///< [m/s^3/sqrt(Hz)]
  double gyro_bias_sigma = 0.0;   ///< [rad/s]
  double accel_bias_sigma = 0.0;  ///< [m/s^2]
  /// Of the class of consumer's MEMS, whose scale errors matter.
  bool consumer = false;
};

/// White noise as read, at least that of fibre-optic units (0.005 deg/sqrt(h),
/// 20 ug/sqrt(Hz)); walks of the biases
/// that are usual beside the quiet densities (imu/known_imus.h); biases of 40 times the quiet density, in
/// [1e-5, 2] deg/s and [0.1, 50] mg. Above 0.001 deg/s/sqrt(Hz) it is a
/// consumer's, with 1 deg/s and 50 mg.
UsualNoise UsualNoiseBeside(const ReadingNoise& noise);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_USUAL_NOISE_H_
