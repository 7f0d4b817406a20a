#ifndef HINDSIGHT_ATTITUDE_VELOCITY_CHANGE_H_
#define HINDSIGHT_ATTITUDE_VELOCITY_CHANGE_H_

#include <Eigen/Core>

#include "attitude/attitude_state.h"
#include "imu/preintegration.h"

namespace hindsight {

/// What two velocities over the Earth at t_i and t_j say of the attitude at t_j:
///   C_nb(t_j) u_b = m_n + noise,
///   u_b = dR' (dv - w_i x l_i) + w_j x l_j,
///   m_n = v_j - v_i + dt ((2 w_ie + w_en) x v - g e_D),
/// with dR, dv of the IMU's summary, w the rates less their errors, and v the
/// mean of both. Without a place the Earth does not turn.
struct VelocityChange {
  Eigen::Vector3d u_b = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d m_n = Eigen::Vector3d::Zero();  ///< [m/s]
  /// Change of u_b with the (true - used) gyro bias (0-2) and scale (3-5).
  Eigen::Matrix<double, 3, 6> by_gyro = Eigen::Matrix<double, 3, 6>::Zero();
  /// The same with the accelerometer's bias [s].
  Eigen::Matrix3d by_accel_bias = Eigen::Matrix3d::Zero();
  /// Of u_b, from the IMU's noise within the interval [m^2/s^2].
  Eigen::Matrix3d noise_b = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d R_n = Eigen::Matrix3d::Zero();  ///< of both velocities
};

/// From `before` to `after`; both within the stream of `integrator`, which has
/// scale Jacobians.
VelocityChange ChangeBetween(const VelocitySample& before,
                             const VelocitySample& after,
                             const AttitudePlace& place,
                             const ImuCalibration& calibration,
                             ImuIntegrator* integrator);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_VELOCITY_CHANGE_H_
