#include "evaluation/euler_error.h"

#include <gtest/gtest.h>

#include "geometry/so3.h"

namespace hindsight {
namespace {

TEST(EulerErrorJacobian, MatchesNumericDifference) {
  const Eigen::Vector3d euler(0.3, -0.7, 2.1);
  const Eigen::Quaterniond q =
      QuaternionFromEuler(euler.x(), euler.y(), euler.z());
  const Eigen::Matrix3d J = EulerErrorJacobian(euler);
  constexpr double step = 1e-6;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d psi = step * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d column = (EulerFromQuaternion(Exp(psi) * q) -
                                    EulerFromQuaternion(Exp(-psi) * q)) /
                                   (2.0 * step);
    EXPECT_LT((J.col(i) - column).norm(), 1e-8) << "axis " << i;
  }
}

}  // namespace
}  // namespace hindsight
