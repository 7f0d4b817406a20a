#include "filters/information.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "filters/kalman.h"

namespace hindsight {
namespace {

/// S with S S' = Y for a Y that is positive semidefinite but for rounding.
ErrorMatrix SquareRoot(const ErrorMatrix& Y) {
  const Eigen::LDLT<ErrorMatrix> ldlt(Y);
  const ErrorMatrix L = ldlt.matrixL();
  const ErrorVector root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  return ldlt.transpositionsP().transpose() * (L * root.asDiagonal());
}

}  // namespace

Information::Information(const ErrorVector& scale)
    : scale_(scale),
      Y_(ErrorMatrix::Zero(scale.size(), scale.size())),
      y_(ErrorVector::Zero(scale.size())) {}

void Information::PropagateBack(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                                const ErrorVector& c) {
  const ErrorVector inverse = scale_.cwiseInverse();
  const ErrorMatrix A = inverse.asDiagonal() * Phi * scale_.asDiagonal();
  const ErrorMatrix N = inverse.asDiagonal() * Q * inverse.asDiagonal();
  const ErrorMatrix S = SquareRoot(Y_);
  const ErrorMatrix NS = N * S;
  ErrorMatrix M = ErrorMatrix::Identity(Phi.rows(), Phi.rows());
  M.noalias() += S.transpose() * NS;
  const Eigen::LLT<ErrorMatrix> llt(M);
  ErrorVector y = y_ - Y_ * inverse.cwiseProduct(c);
  y -= S * llt.solve(NS.transpose() * y);
  y_ = A.transpose() * y;
  ErrorMatrix W = S.transpose() * A;
  llt.matrixL().solveInPlace(W);
  Y_.noalias() = W.transpose() * W;
  Symmetrize(&Y_);
}

void Information::Substitute(const ErrorMatrix& T, const ErrorVector& shift) {
  const ErrorVector inverse = scale_.cwiseInverse();
  const ErrorMatrix A = inverse.asDiagonal() * T * scale_.asDiagonal();
  const ErrorMatrix YA = Y_ * A;
  y_ = (A.transpose() * (y_ + YA * inverse.cwiseProduct(shift))).eval();
  Y_.noalias() = A.transpose() * YA;
  Symmetrize(&Y_);
}

void Information::Add(const RowJacobian& H, const RowMatrix& R,
                      const RowVector& z) {
  const RowJacobian A = H * scale_.asDiagonal();
  const Eigen::LLT<RowMatrix> llt(R);
  const RowJacobian W = llt.matrixL().solve(A);
  const RowVector w = llt.matrixL().solve(z);
  Y_.noalias() += W.transpose() * W;
  y_.noalias() += W.transpose() * w;
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
  const ErrorMatrix YL = Y_ * L;
  ErrorMatrix M = ErrorMatrix::Identity(m.size(), m.size());
  M.noalias() += L.transpose() * YL;
  const Eigen::LLT<ErrorMatrix> llt(M);
  const ErrorMatrix W = llt.matrixL().solve(L.transpose());
  Estimate out;
  out.P.noalias() = W.transpose() * W;
  const ErrorVector u = y_ - Y_ * inverse.cwiseProduct(m);
  out.mean = m + scale_.cwiseProduct(W.transpose() * (W * u));
  out.P = (scale_.asDiagonal() * out.P * scale_.asDiagonal()).eval();
  Symmetrize(&out.P);
  return out;
}

double Information::Separation(const ErrorVector& m, const ErrorMatrix& P_f,
                               int first, int count) const {
  // A prior of 1e7 scales keeps Y regular and weighs nothing where the
  // measurements speak.
  constexpr double kWeakPrior = 1e-14;
  constexpr double kLargestSigma = 1e6;
  const Eigen::Index n = m.size();
  const ErrorVector inverse = scale_.cwiseInverse();
  ErrorMatrix Y = Y_;
  Y.diagonal().array() += kWeakPrior;
  const Eigen::LDLT<ErrorMatrix> ldlt(Y);
  ErrorMatrix E = ErrorMatrix::Zero(n, count);
  E.middleRows(first, count).setIdentity();
  const ErrorMatrix X = ldlt.solve(E);
  const ErrorVector u = y_ - Y_ * inverse.cwiseProduct(m);
  ErrorMatrix P = X.middleRows(first, count);
  const double largest = P.diagonal().maxCoeff();
  const double smallest = P.diagonal().minCoeff();
  if (!(smallest > 0.0) || !(largest < kLargestSigma * kLargestSigma)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const ErrorVector e = X.transpose() * u;
  const auto s = inverse.segment(first, count);
  P += s.asDiagonal() * P_f.block(first, first, count, count) * s.asDiagonal();
  Symmetrize(&P);
  return std::sqrt(e.dot(P.ldlt().solve(e)));
}

}  // namespace hindsight
