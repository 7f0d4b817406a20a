#include "receiver_errors/later_likelihood.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "linear/householder.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// Components that a covariance moves at all.
std::vector<Eigen::Index> NoisyOf(const ErrorMatrix& Q) {
  std::vector<Eigen::Index> noisy;
  for (Eigen::Index i = 0; i < Q.rows(); ++i) {
    if (Q(i, i) != 0.0) noisy.push_back(i);
  }
  return noisy;
}

/// I + U P U', of which nothing above the diagonal is said; UP gets U P.
template <typename Factor>
ErrorMatrix OneAndCongruence(const Factor& U, const ErrorMatrix& P,
                             ErrorMatrix* UP) {
  ErrorMatrix S;
  Multiply(U, P, /*lower=*/false, UP);
  Multiply(*UP, U.transpose(), /*lower=*/true, &S);
  S.diagonal().array() += 1.0;
  return S;
}

}  // namespace

void LaterLikelihood::Add(const LinearizedMeasurement& y) {
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
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
  Householder householder;
  for (Eigen::Index j = 0; j <= n; ++j) {
    double* top = stacked.row(j).data();
    const RowRange below = {top + n + 1, n + 1, n + rows - 1 - j};
    householder.Reflect(top, below, j, n + 1, ColumnNorm(top, below, j));
  }
  U_ = stacked.topLeftCorner(n, n).triangularView<Eigen::Upper>();
  z_ = stacked.col(n).head(n);
  const double left = stacked(n, n);
  c_ -= 0.5 * left * left + llt.matrixLLT().diagonal().array().log().sum() +
        0.5 * static_cast<double>(rows) * std::log(2.0 * kPi);
}

void LaterLikelihood::BackOver(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                               const ErrorVector& d) {
  const std::vector<Eigen::Index> noisy = NoisyOf(Q);
  const ErrorMatrix U_noisy = U_(Eigen::all, noisy);
  ErrorMatrix UQ;
  const Eigen::LLT<ErrorMatrix> G(
      OneAndCongruence(U_noisy, Q(noisy, noisy), &UQ));
  c_ -= G.matrixLLT().diagonal().array().log().sum();
  z_ -= U_ * d;
  G.matrixL().solveInPlace(z_);
  U_ = Times(U_, Phi);
  G.matrixL().solveInPlace(U_);
}

Gaussian LaterLikelihood::Joined(const Gaussian& before) const {
  ErrorMatrix UP;
  const auto U = U_.leftCols(before.mean.size());
  const Eigen::LLT<ErrorMatrix> G(OneAndCongruence(U, before.P, &UP));
  const ErrorMatrix GUP = G.matrixL().solve(UP);
  ErrorVector whitened = z_ - U * before.mean;
  G.matrixL().solveInPlace(whitened);
  Gaussian joined = before;
  joined.mean += GUP.transpose() * whitened;
  joined.P.noalias() -= GUP.transpose() * GUP;
  return joined;
}

double LaterLikelihood::LogMean(const Gaussian& before) const {
  ErrorMatrix UP;
  const auto U = U_.leftCols(before.mean.size());
  const Eigen::LLT<ErrorMatrix> G(OneAndCongruence(U, before.P, &UP));
  if (G.info() != Eigen::Success) {
    return -std::numeric_limits<double>::infinity();
  }
  ErrorVector whitened = z_ - U * before.mean;
  G.matrixL().solveInPlace(whitened);
  return c_ - 0.5 * whitened.squaredNorm() -
         G.matrixLLT().diagonal().array().log().sum();
}

}  // namespace hindsight
