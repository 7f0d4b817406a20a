#ifndef HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
#define HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_

#include <Eigen/Core>

#include "linear/small_product.h"

namespace hindsight {

/// Of a product with a matrix so small that to pass over its zeros does not pay.
inline constexpr Eigen::Index kDense = 16;

/// A S' for an S of mostly zeros, such as a transition: with m elements that are
/// not zero, m columns of A are added up where a dense product adds n^2.
template <typename Dense, typename Sparse>
typename Dense::PlainObject TimesTransposed(
    const Eigen::MatrixBase<Dense>& A, const Eigen::MatrixBase<Sparse>& S) {
  typename Dense::PlainObject out(A.rows(), S.rows());
  if (S.rows() <= kDense && S.cols() <= kDense) {
    Multiply(A.derived(), S.derived().transpose(), /*lower=*/false, &out);
    return out;
  }
  out.setZero();
  for (Eigen::Index j = 0; j < S.cols(); ++j) {
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      if (S(i, j) != 0.0) out.col(i) += S(i, j) * A.col(j);
    }
  }
  return out;
}

/// A S for such an S.
template <typename Dense, typename Sparse>
typename Dense::PlainObject Times(const Eigen::MatrixBase<Dense>& A,
                                  const Eigen::MatrixBase<Sparse>& S) {
  typename Dense::PlainObject out(A.rows(), S.cols());
  if (S.rows() <= kDense && S.cols() <= kDense) {
    Multiply(A.derived(), S.derived(), /*lower=*/false, &out);
    return out;
  }
  out.setZero();
  for (Eigen::Index j = 0; j < S.cols(); ++j) {
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      if (S(i, j) != 0.0) out.col(j) += S(i, j) * A.col(i);
    }
  }
  return out;
}

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
