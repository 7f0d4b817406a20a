#include "alignment/davenport.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace hindsight {

Eigen::Matrix3d VectorMatch::Covariance(double largest) const {
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double variance = gaps(i) > 2.0 / largest ? 2.0 / gaps(i) : largest;
    P += variance * axes.col(i) * axes.col(i).transpose();
  }
  return P;
}

VectorMatch MatchVectors(const Eigen::Matrix3d& B) {
  const Eigen::Vector3d z(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0),
                          B(1, 0) - B(0, 1));
  Eigen::Matrix4d K;
  K(0, 0) = B.trace();
  K.block<3, 1>(1, 0) = z;
  K.block<1, 3>(0, 1) = z.transpose();
  K.block<3, 3>(1, 1) =
      B + B.transpose() - B.trace() * Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(K);
  const auto quaternion = [&](int i) {
    const Eigen::Vector4d v = eigen.eigenvectors().col(i);
    return Eigen::Quaterniond(v(0), v(1), v(2), v(3));
  };
  VectorMatch match;
  match.q = quaternion(3);
  for (int i = 0; i < 3; ++i) {
    match.axes.col(i) = (quaternion(2 - i) * match.q.conjugate()).vec();
    match.gaps(i) = eigen.eigenvalues()(3) - eigen.eigenvalues()(2 - i);
  }
  return match;
}

}  // namespace hindsight
