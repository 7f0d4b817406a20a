#include "evaluation/euler_error.h"

#include <cmath>

namespace hindsight {

Eigen::Matrix3d EulerErrorJacobian(const Eigen::Vector3d& euler) {
  const double cos_p = std::cos(euler.y());
  const double tan_p = std::tan(euler.y());
  const double sin_h = std::sin(euler.z());
  const double cos_h = std::cos(euler.z());
  Eigen::Matrix3d J;
  J << cos_h / cos_p, sin_h / cos_p, 0.0,  //
      -sin_h, cos_h, 0.0,                  //
      cos_h * tan_p, sin_h * tan_p, 1.0;
  return J;
}

}  // namespace hindsight
