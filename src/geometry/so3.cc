#include "geometry/so3.h"

#include <cmath>

#include "base/units.h"

namespace hindsight {

Eigen::Quaterniond Exp(const Eigen::Vector3d& v) {
  const double angle2 = v.squaredNorm();
  if (angle2 < kSmallAngle2) return SmallExp<double>(v);
  const double angle = std::sqrt(angle2);
  const double s = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), s * v.x(), s * v.y(), s * v.z()};
}

Eigen::Vector3d Log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d u = sign * q.vec();
  const double w = sign * q.w();
  const double n2 = u.squaredNorm();
  if (n2 < 1e-10 * w * w) {
    const double x2 = n2 / (w * w);
    return (2.0 / w) * (1.0 - x2 / 3.0) * u;
  }
  const double n = std::sqrt(n2);
  return (2.0 * std::atan2(n, w) / n) * u;
}

Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& v) {
  const double a2 = v.squaredNorm();
  const Eigen::Matrix3d V = Skew(v);
  double c1 = 0.5 - a2 / 24.0;
  double c2 = 1.0 / 6.0 - a2 / 120.0;
  if (a2 > 1e-6) {
    const double a = std::sqrt(a2);
    c1 = (1.0 - std::cos(a)) / a2;
    c2 = (a - std::sin(a)) / (a2 * a);
  }
  return Eigen::Matrix3d::Identity() - c1 * V + c2 * V * V;
}

Eigen::Matrix3d RightJacobianInverse(const Eigen::Vector3d& v) {
  const double a2 = v.squaredNorm();
  const Eigen::Matrix3d V = Skew(v);
  double c = 1.0 / 12.0 + a2 / 720.0;
  if (a2 > 1e-4) {
    const double a = std::sqrt(a2);
    c = 1.0 / a2 - 0.5 / (a * std::tan(0.5 * a));
  }
  return Eigen::Matrix3d::Identity() + 0.5 * V + c * V * V;
}

Eigen::Matrix<double, 4, 3> LeftPlusJacobian(const Eigen::Quaterniond& q) {
  const double x = 0.5 * q.x();
  const double y = 0.5 * q.y();
  const double z = 0.5 * q.z();
  const double w = 0.5 * q.w();
  Eigen::Matrix<double, 4, 3> J;
  J << w, z, -y,  //
      -z, w, x,   //
      y, -x, w,   //
      -x, -y, -z;
  return J;
}

Eigen::Quaterniond QuaternionFromEuler(double roll, double pitch,
                                       double heading) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return Eigen::Quaterniond(AngleAxisd(heading, Vector3d::UnitZ()) *
                            AngleAxisd(pitch, Vector3d::UnitY()) *
                            AngleAxisd(roll, Vector3d::UnitX()));
}

Eigen::Vector3d EulerFromQuaternion(const Eigen::Quaterniond& q_nb) {
  const Eigen::Matrix3d C = q_nb.normalized().toRotationMatrix();
  const double sin_pitch = -C(2, 0);
  const double cos_pitch = std::hypot(C(2, 1), C(2, 2));
  const double pitch = std::atan2(sin_pitch, cos_pitch);
  if (cos_pitch < 1e-12) {
    return {0.0, pitch, std::atan2(-C(0, 1), C(1, 1))};
  }
  return {std::atan2(C(2, 1), C(2, 2)), pitch, std::atan2(C(1, 0), C(0, 0))};
}

double WrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

}  // namespace hindsight
