#ifndef HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
#define HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

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

/// S P S' of square matrices for one S of mostly zeros, whose elements are
/// sought once, and many symmetric P, and S v.
class SparseCongruence {
 public:
  SparseCongruence() = default;

  template <typename Sparse>
  explicit SparseCongruence(const Eigen::MatrixBase<Sparse>& S) {
    ends_.reserve(static_cast<std::size_t>(S.rows()));
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      for (Eigen::Index j = 0; j < S.cols(); ++j) {
        if (S(i, j) != 0.0) elements_.push_back({j, S(i, j)});
      }
      ends_.push_back(elements_.size());
    }
  }

  /// S v.
  template <typename Vector>
  Vector Times(const Vector& v) const {
    Vector out = Vector::Zero(v.size());
    std::size_t e = 0;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      double& sum = out(static_cast<Eigen::Index>(i));
      for (; e < ends_[i]; ++e)
        sum += elements_[e].value * v(elements_[e].column);
    }
    return out;
  }

  /// S P S', symmetric to the last bit. P and the result are column-major.
  template <typename Matrix>
  Matrix operator()(const Matrix& P) const {
    Matrix PSt(P.rows(), P.cols());
    AddUp(P, /*lower=*/false, &PSt);
    const Matrix SP = PSt.transpose();
    Matrix out(P.rows(), P.cols());
    AddUp(SP, /*lower=*/true, &out);
    for (Eigen::Index j = 1; j < out.cols(); ++j) {
      out.col(j).head(j) = out.row(j).head(j).transpose();
    }
    return out;
  }

 private:
  struct Element {
    Eigen::Index column;
    double value;
  };

  /// out = A S', of which `lower` asks for no element above the diagonal.
  template <typename Matrix>
  void AddUp(const Matrix& A, bool lower, Matrix* out) const {
    constexpr Eigen::Index kStrip = 8;
    const Eigen::Index rows = A.rows();
    for (Eigen::Index j = 0; j < rows; ++j) {
      Eigen::Index i = lower ? j : 0;
      if (rows < kStrip) {
        for (; i < rows; ++i) AddUpStrip<1>(A, i, j, out);
        continue;
      }
      for (; i + kStrip < rows; i += kStrip) AddUpStrip<kStrip>(A, i, j, out);
      // The last strip may do some rows once more.
      AddUpStrip<kStrip>(A, rows - kStrip, j, out);
    }
  }

  /// Rows from `first` on of column j of the result, kept in registers.
  template <int Rows, typename Matrix>
  void AddUpStrip(const Matrix& A, Eigen::Index first, Eigen::Index j,
                  Matrix* out) const {
    using Strip = Eigen::Array<double, Rows, 1>;
    Strip sum = Strip::Zero();
    const auto row = static_cast<std::size_t>(j);
    const std::size_t end = ends_[row];
    for (std::size_t e = j > 0 ? ends_[row - 1] : 0; e < end; ++e) {
      const double* column =
          A.data() + elements_[e].column * A.outerStride() + first;
      sum += elements_[e].value * Eigen::Map<const Strip>(column);
    }
    Eigen::Map<Strip>(out->data() + j * out->outerStride() + first) = sum;
  }

  std::vector<Element> elements_;  ///< row by row
  std::vector<std::size_t> ends_;  ///< of each row in elements_
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
