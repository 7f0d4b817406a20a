#include "filters/information.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "base/error.h"
#include "filters/kalman.h"

namespace hindsight {
namespace {

/// [U z] with the rows of a measurement below.
using StackedMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                    kMaxErrorDim + kMaxRows, kMaxErrorDim + 1>;

}  // namespace

Information::Information(const ErrorVector& scale)
    : scale_(scale),
      U_(ErrorMatrix::Zero(scale.size(), scale.size())),
      z_(ErrorVector::Zero(scale.size())) {}

void Information::PropagateBack(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                                const ErrorVector& c) {
  const ErrorMatrix V = U_ * scale_.cwiseInverse().asDiagonal();
  const ErrorMatrix VQ = V * Q;
  ErrorMatrix M = ErrorMatrix::Identity(Phi.rows(), Phi.rows());
  M.noalias() += VQ * V.transpose();
  const Eigen::LLT<ErrorMatrix> llt(M);
  z_ -= V * c;
  llt.matrixL().solveInPlace(z_);
  U_.noalias() = V * Phi;
  U_ = (U_ * scale_.asDiagonal()).eval();
  llt.matrixL().solveInPlace(U_);
}

void Information::Substitute(const ErrorMatrix& T, const ErrorVector& shift) {
  const ErrorMatrix V = U_ * scale_.cwiseInverse().asDiagonal();
  const ErrorMatrix VT = V * T;
  z_ += VT * shift;
  U_ = VT * scale_.asDiagonal();
}

void Information::Add(const RowJacobian& H, const RowMatrix& R,
                      const RowVector& z) {
  const Eigen::LLT<RowMatrix> llt(R);
  if (llt.info() != Eigen::Success) {
    throw EstimationError("measurement noise is not positive definite");
  }
  const Eigen::Index n = scale_.size();
  StackedMatrix stacked(n + H.rows(), n + 1);
  stacked.topLeftCorner(n, n) = U_;
  stacked.topRightCorner(n, 1) = z_;
  stacked.bottomLeftCorner(H.rows(), n) =
      llt.matrixL().solve(RowJacobian(H * scale_.asDiagonal()));
  stacked.bottomRightCorner(H.rows(), 1) = llt.matrixL().solve(z);
  const Eigen::HouseholderQR<StackedMatrix> qr(stacked);
  const auto R_qr = qr.matrixQR().topRows(n);
  U_ = R_qr.leftCols(n).triangularView<Eigen::Upper>();
  z_ = R_qr.col(n);
}

Information::Estimate Information::Fuse(const ErrorVector& m,
                                        const ErrorMatrix& P_f) const {
  const ErrorVector inverse = scale_.cwiseInverse();
  const ErrorMatrix P = inverse.asDiagonal() * P_f * inverse.asDiagonal();
  const Eigen::LLT<ErrorMatrix> forward(P);
  if (forward.info() != Eigen::Success) {
    throw EstimationError("forward covariance is not positive definite");
  }
  const ErrorMatrix L = forward.matrixL();
  const ErrorMatrix UL = U_ * L;
  ErrorMatrix M = ErrorMatrix::Identity(m.size(), m.size());
  M.noalias() += UL.transpose() * UL;
  const Eigen::LLT<ErrorMatrix> llt(M);
  const ErrorMatrix W = llt.matrixL().solve(L.transpose());
  const ErrorVector u = z_ - U_ * inverse.cwiseProduct(m);
  Estimate out;
  out.mean = m + scale_.cwiseProduct(L * llt.solve(UL.transpose() * u));
  out.P.noalias() = W.transpose() * W;
  out.P = (scale_.asDiagonal() * out.P * scale_.asDiagonal()).eval();
  Symmetrize(&out.P);
  return out;
}

Information::Estimate Information::AloneAbout(const ErrorVector& m) const {
  constexpr double kWeakPrior = 1e-14;
  const ErrorVector inverse = scale_.cwiseInverse();
  ErrorMatrix Y = U_.transpose() * U_;
  Y.diagonal().array() += kWeakPrior;
  const Eigen::LDLT<ErrorMatrix> ldlt(Y);
  Estimate out;
  out.P = ldlt.solve(ErrorMatrix::Identity(m.size(), m.size()));
  const ErrorVector u = U_.transpose() * (z_ - U_ * inverse.cwiseProduct(m));
  out.mean = scale_.cwiseProduct(out.P.transpose() * u);
  out.P = (scale_.asDiagonal() * out.P * scale_.asDiagonal()).eval();
  Symmetrize(&out.P);
  return out;
}

}  // namespace hindsight
