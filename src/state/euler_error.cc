#include "state/euler_error.h"

#include <cmath>

namespace hindsight {
namespace {

/// D: by what the NED axes turn with a displacement in NED.
Eigen::Matrix3d TurnOfAxes(const State& x) {
  const Geodetic g = GeodeticFromEcef(x.p_e);
  Eigen::Matrix3d D;
  for (int i = 0; i < 3; ++i) {
    D.col(i) = TransportRate_n(g, Eigen::Vector3d::Unit(i));
  }
  return D;
}

}  // namespace

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

Eigen::Vector3d EulerSigma(const Eigen::Vector3d& euler,
                           const Eigen::Matrix3d& P_phi) {
  const Eigen::Matrix3d J = EulerErrorJacobian(euler);
  const Eigen::Array3d variance = (J * P_phi * J.transpose()).diagonal();
  // At the vertical itself infinity times nothing is no number.
  return variance.isNaN()
      .select(kUnknownAngleSigma,
              variance.max(0.0).sqrt().min(kUnknownAngleSigma))
      .matrix();
}

Eigen::Vector3d EulerSigma(const ErrorLayout& layout, const State& x,
                           const ErrorMatrix& P) {
  const int a = layout.Find(BlockKind::kAttitude)->offset;
  Eigen::Matrix3d P_phi = P.block<3, 3>(a, a);
  const Block* position = layout.Find(BlockKind::kPosition);
  if (position != nullptr && position->dim == 3) {
    const int p = position->offset;
    const Eigen::Matrix3d D = TurnOfAxes(x);
    const Eigen::Matrix3d cross = D * P.block<3, 3>(p, a);
    P_phi +=
        D * P.block<3, 3>(p, p) * D.transpose() - cross - cross.transpose();
  }
  return EulerSigma(x.euler(), P_phi);
}

}  // namespace hindsight
