#ifndef HINDSIGHT_TESTS_FILTERS_DENSE_LEAST_SQUARES_H_
#define HINDSIGHT_TESTS_FILTERS_DENSE_LEAST_SQUARES_H_

#include <Eigen/Cholesky>

#include "filters/linear_tape.h"

namespace hindsight::testing {

/// Errors about x_minus of all epochs of a tape about one fixed nominal, from
/// one dense normal equation that knows no recursion.
struct DenseSolution {
  Eigen::VectorXd d;
  Eigen::MatrixXd P;

  Eigen::VectorXd At(std::size_t k, int n) const {
    return d.segment(static_cast<Eigen::Index>(k) * n, n);
  }
  Eigen::MatrixXd CovarianceAt(std::size_t k, int n) const {
    return P.block(static_cast<Eigen::Index>(k) * n,
                   static_cast<Eigen::Index>(k) * n, n, n);
  }
};

inline DenseSolution SolveDense(const LinearTape& tape) {
  const Eigen::Index n = tape.dim();
  const auto count = static_cast<Eigen::Index>(tape.size());
  Eigen::MatrixXd Lambda = Eigen::MatrixXd::Zero(n * count, n * count);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n * count);
  // Adds |W^(-1/2) (A d - y)|^2.
  const auto add = [&](const Eigen::MatrixXd& A, const Eigen::VectorXd& y,
                       const Eigen::MatrixXd& W, Eigen::Index column) {
    const Eigen::LLT<Eigen::MatrixXd> llt(W);
    const Eigen::MatrixXd W_A = llt.solve(A);
    Lambda.block(column, column, A.cols(), A.cols()) += A.transpose() * W_A;
    b.segment(column, A.cols()) += W_A.transpose() * y;
  };
  add(Eigen::MatrixXd::Identity(n, n), tape.epoch(0).dx_minus, tape.P_minus(0),
      0);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto epoch = static_cast<std::size_t>(k);
    if (k > 0) {
      Eigen::MatrixXd A(n, 2 * n);
      A << -tape.Phi(epoch), Eigen::MatrixXd::Identity(n, n);
      add(A, tape.epoch(epoch).c, tape.Q(epoch), n * (k - 1));
    }
    for (const TapeMeasurement& z : tape.measurements(epoch)) {
      if (z.accepted) add(z.H, z.residual, z.R, n * k);
    }
  }
  // Unit diagonal: metres and radians side by side.
  const Eigen::VectorXd s = Lambda.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> llt(s.asDiagonal() * Lambda *
                                        s.asDiagonal());
  DenseSolution out;
  out.d = s.cwiseProduct(llt.solve(s.cwiseProduct(b)));
  out.P = s.asDiagonal() *
          llt.solve(Eigen::MatrixXd::Identity(n * count, n * count)) *
          s.asDiagonal();
  return out;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_FILTERS_DENSE_LEAST_SQUARES_H_
