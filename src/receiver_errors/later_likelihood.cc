#include "receiver_errors/later_likelihood.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {

void LaterLikelihood::Add(const LinearizedMeasurement& y) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                             kMaxErrorDim + kMaxRows, kMaxErrorDim + 1>;
  const Eigen::LLT<RowMatrix> llt(y.R);
  if (llt.info() != Eigen::Success) {
    throw EstimationError("measurement noise is not positive definite");
  }
  const Eigen::Index n = z_.size();
  const Eigen::Index rows = y.residual.size();
  Rows stacked(n + rows, n + 1);
  stacked.topLeftCorner(n, n) = U_;
  stacked.topRightCorner(n, 1) = z_;
  stacked.bottomLeftCorner(rows, n) = llt.matrixL().solve(y.H);
  stacked.bottomRightCorner(rows, 1) = llt.matrixL().solve(y.residual);
  const Eigen::HouseholderQR<Rows> qr(stacked);
  const auto& R = qr.matrixQR();
  U_ = R.topLeftCorner(n, n).triangularView<Eigen::Upper>();
  z_ = R.col(n).head(n);
  c_ -= 0.5 * R(n, n) * R(n, n) +
        llt.matrixLLT().diagonal().array().log().sum() +
        0.5 * static_cast<double>(rows) * std::log(2.0 * kPi);
}

void LaterLikelihood::BackOver(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                               const ErrorVector& d) {
  ErrorMatrix S = ErrorMatrix::Identity(z_.size(), z_.size());
  const ErrorMatrix UQ = U_ * Q;
  S.noalias() += UQ * U_.transpose();
  const Eigen::LLT<ErrorMatrix> G(S);
  c_ -= G.matrixLLT().diagonal().array().log().sum();
  z_ -= U_ * d;
  G.matrixL().solveInPlace(z_);
  U_ = (U_ * Phi).eval();
  G.matrixL().solveInPlace(U_);
}

Gaussian LaterLikelihood::Joined(const Gaussian& before) const {
  ErrorMatrix S = ErrorMatrix::Identity(z_.size(), z_.size());
  const ErrorMatrix UP = U_ * before.P;
  S.noalias() += UP * U_.transpose();
  const Eigen::LLT<ErrorMatrix> G(S);
  const ErrorMatrix GUP = G.matrixL().solve(UP);
  ErrorVector whitened = z_ - U_ * before.mean;
  G.matrixL().solveInPlace(whitened);
  Gaussian joined = before;
  joined.mean += GUP.transpose() * whitened;
  joined.P.noalias() -= GUP.transpose() * GUP;
  return joined;
}

double LaterLikelihood::LogMean(const Gaussian& before) const {
  ErrorMatrix S = ErrorMatrix::Identity(z_.size(), z_.size());
  const ErrorMatrix UP = U_ * before.P;
  S.noalias() += UP * U_.transpose();
  const Eigen::LLT<ErrorMatrix> G(S);
  if (G.info() != Eigen::Success) {
    return -std::numeric_limits<double>::infinity();
  }
  ErrorVector whitened = z_ - U_ * before.mean;
  G.matrixL().solveInPlace(whitened);
  return c_ - 0.5 * whitened.squaredNorm() -
         G.matrixLLT().diagonal().array().log().sum();
}

}  // namespace hindsight
