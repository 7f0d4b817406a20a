#include "alignment/start_covariance.h"

#include "alignment/start_layout.h"

namespace hindsight {
namespace {

/// Whether what levelling knows holds at any heading that is possible.
bool LevelHoldsAtAnyHeading(const Dataset& dataset,
                            const AlignedAttitude& attitude) {
  const Eigen::Matrix3d& P = attitude.P;
  const Eigen::Vector3d weight =
      AccelBiasSigma(dataset.initial).cwiseAbs2().cwiseInverse();
  const Eigen::Matrix<double, 2, 3> C = attitude.P_bias.topRightCorner<2, 3>();
  const Eigen::Vector2d tilt = P.diagonal().head<2>();
  const Eigen::Vector2d open =
      tilt - (C * weight.asDiagonal() * C.transpose()).diagonal();
  return 0.25 * P(2, 2) * tilt.maxCoeff() < open.maxCoeff();
}

}  // namespace

ErrorMatrix StartCovariance(const Dataset& dataset, const ErrorLayout& layout,
                            const AlignedAttitude& attitude, double factor) {
  ErrorMatrix P = InitialCovariance(dataset, layout);
  const int a = layout.Find(BlockKind::kAttitude)->offset;
  const int b = layout.Find(BlockKind::kGyroBias)->offset;
  const Eigen::Vector3d f =
      (kUnknownHeadingSigma / attitude.P.diagonal().array().sqrt())
          .max(1.0)
          .min(factor);
  P.block<3, 3>(a, a) = f.asDiagonal() * attitude.P * f.asDiagonal();
  if ((f.array() == 1.0).all()) {
    P.block<3, 6>(a, b) = attitude.P_bias;
    P.block<6, 3>(b, a) = attitude.P_bias.transpose();
  }
  return P;
}

ErrorMatrix PriorCovariance(const Dataset& dataset, const ErrorLayout& layout,
                            const AlignedAttitude& attitude) {
  if (LevelHoldsAtAnyHeading(dataset, attitude)) {
    return StartCovariance(dataset, layout, attitude, attitude.reuse);
  }
  constexpr double kAnew = 10.0;
  ErrorMatrix P = InitialCovariance(dataset, layout);
  const int a = layout.Find(BlockKind::kAttitude)->offset;
  P.block<3, 3>(a, a).setZero();
  P.diagonal().segment<2>(a) = kAnew * kAnew * attitude.P.diagonal().head<2>();
  P(a + 2, a + 2) = attitude.P(2, 2);
  return P;
}

}  // namespace hindsight
