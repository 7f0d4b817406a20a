#ifndef HINDSIGHT_IMU_ROTATION_SUMMARY_H_
#define HINDSIGHT_IMU_ROTATION_SUMMARY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/so3.h"
#include "imu/imu_noise.h"
#include "imu/sample_integral.h"

namespace hindsight {

/// The rotation part of an ImuSummary over one sample interval, for filters
/// that estimate attitude and gyro bias alone and update at every sample:
/// dR = Exp(phi), d phi / d b_g = -dt, white noise of `variance` an axis, all
/// as Preintegrator has them for one sample but for terms of order (w dt)^2 of
/// the noise.
struct RotationSummary {
  double dt = 0.0;
  Eigen::Vector3d phi;    ///< rotation vector, body axes at the start [rad]
  double variance = 0.0;  ///< of an axis of phi [rad^2]
};

/// With coning, phi = dt (w0 + w1)/2 + dt^2/12 w0 x w1, w less `b_g`, rates
/// linear from w0 to w1.
inline RotationSummary SummarizeRotation(const ImuNoise& noise, double dt,
                                         const Eigen::Vector3d& w0,
                                         const Eigen::Vector3d& w1,
                                         const Eigen::Vector3d& b_g) {
  const Eigen::Vector3d a = w0 - b_g;
  const Eigen::Vector3d b = w1 - b_g;
  const Eigen::Vector3d mean = 0.5 * (a + b);
  return {dt, dt * mean + (dt * dt / 12.0) * a.cross(b),
          dt * GyroWhiteNoise(noise, mean.squaredNorm())};
}

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_ROTATION_SUMMARY_H_
