#ifndef HINDSIGHT_ATTITUDE_FORCE_INTEGRAL_H_
#define HINDSIGHT_ATTITUDE_FORCE_INTEGRAL_H_

#include <Eigen/Core>

#include "geometry/so3.h"

namespace hindsight {

/// Integrals in axes i that do not turn, from some time on: of the specific
/// force, and of what a gyro bias does to it.
struct ForceIntegral {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< int f_i dt [m/s]
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();  ///< int C_ib dt [s]
  /// int [f_i x] (int C_ib dt) dt [m/s^2 s^2].
  Eigen::Matrix3d fC = Eigen::Matrix3d::Zero();

  /// Over dt of the mean force f_i; C_ib is the mean, or zero where the gyros
  /// are not what the attitude follows.
  void Add(double dt, const Eigen::Vector3d& f_i, const Eigen::Matrix3d& C_ib) {
    fC += Skew(dt * f_i) * (C + 0.5 * dt * C_ib);
    f += dt * f_i;
    C += dt * C_ib;
  }

  /// What a gyro bias error db adds to the force from `begin` to here, as seen
  /// from the axes of here: psi_i(t) = psi_i + (C - C(t)) db, and the error of
  /// the force is the integral of psi_i(t) x f_i.
  Eigen::Matrix3d ByBias(const ForceIntegral& begin) const {
    return -(Skew(f - begin.f) * C - (fC - begin.fC));
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_FORCE_INTEGRAL_H_
