#ifndef HINDSIGHT_GEOMETRY_SO3_H_
#define HINDSIGHT_GEOMETRY_SO3_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hindsight {

/// [v x], so that Skew(v) * u = v.cross(u).
inline Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Unit quaternion of the rotation vector v [rad], |v| of any size.
Eigen::Quaterniond Exp(const Eigen::Vector3d& v);

/// The same where SmallExp holds to rounding, |v|^2 below this [rad^2]; it spares the
/// square root and the trigonometry in the IMU loop.
inline constexpr double kSmallAngle2 = 1e-2;
/// By the eighth-order series.
template <typename Real>
Eigen::Quaternion<Real> SmallExp(const Eigen::Matrix<Real, 3, 1>& v) {
  const Real h2 = 0.25 * v.squaredNorm();
  const Real s =
      0.5 * (1.0 - (1.0 / 6.0) * h2 *
                       (1.0 - (1.0 / 20.0) * h2 * (1.0 - (1.0 / 42.0) * h2)));
  const Real w =
      1.0 -
      0.5 * h2 *
          (1.0 - (1.0 / 12.0) * h2 *
                     (1.0 - (1.0 / 30.0) * h2 * (1.0 - (1.0 / 56.0) * h2)));
  return {w, s * v.x(), s * v.y(), s * v.z()};
}

/// Rotation vector of q, |.| <= pi. q need not be normalised exactly.
Eigen::Vector3d Log(const Eigen::Quaterniond& q);

/// Jr(v): Exp(v + d) = Exp(v) Exp(Jr d) to first order.
Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& v);
/// Jr(v)^-1: Log(Exp(v) Exp(d)) = v + Jr^-1 d to first order.
Eigen::Matrix3d RightJacobianInverse(const Eigen::Vector3d& v);
/// Jl(v) = Jr(-v): Exp(v + d) = Exp(Jl d) Exp(v) to first order.
inline Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& v) {
  return RightJacobian(-v);
}
inline Eigen::Matrix3d LeftJacobianInverse(const Eigen::Vector3d& v) {
  return RightJacobianInverse(-v);
}

/// d(q coefficients x y z w)/d(phi) at phi = 0 of Exp(phi) * q: the 4 x 3
/// Jacobian of a rotation applied on the left, in Eigen's coefficient order.
Eigen::Matrix<double, 4, 3> LeftPlusJacobian(const Eigen::Quaterniond& q);

/// Body-to-navigation attitude from roll, pitch, heading [rad], ZYX order:
/// C_nb = Rz(heading) Ry(pitch) Rx(roll); n is north-east-down, b is
/// forward-right-down.
Eigen::Quaterniond QuaternionFromEuler(double roll, double pitch,
                                       double heading);

/// (roll, pitch, heading) [rad] of q_nb; roll and heading in (-pi, pi], pitch
/// in [-pi/2, pi/2]. At pitch = +-pi/2 roll is set to zero.
Eigen::Vector3d EulerFromQuaternion(const Eigen::Quaterniond& q_nb);

/// Angle folded into (-pi, pi].
double WrapAngle(double angle);

}  // namespace hindsight

#endif  // HINDSIGHT_GEOMETRY_SO3_H_
