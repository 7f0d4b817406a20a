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

/// Products of one square S of mostly zeros, whose elements are sought once: S P S' of
/// symmetric P, S A and S v. Rows of S that are those of the identity, as of constants in
/// a transition, cost nothing: what P has of two of them stays. P may be larger than S:
/// rows that S has not are those of the identity.
class SparseCongruence {
 public:
  SparseCongruence() = default;

  template <typename Sparse>
  explicit SparseCongruence(const Eigen::MatrixBase<Sparse>& S) {
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      AddRow(i, 0, S.cols(), [&](Eigen::Index j) { return S(i, j); });
    }
  }

  /// Adds row i of S, in the order of rows, of which of(j) are the elements j with
  /// begin <= j < end, and all others zero.
  template <typename Of>
  void AddRow(Eigen::Index i, Eigen::Index begin, Eigen::Index end,
              const Of& of) {
    const std::size_t first = elements_.size();
    for (Eigen::Index j = begin; j < end; ++j) {
      const double value = of(j);
      if (value != 0.0) elements_.push_back({j, value});
    }
    const bool is_of_identity = elements_.size() == first + 1 &&
                                elements_[first].column == i &&
                                elements_[first].value == 1.0;
    if (is_of_identity) {
      elements_.pop_back();
      return;
    }
    rows_.push_back(i);
    ends_.push_back(elements_.size());
  }

  /// S A in the place of A.
  template <typename Matrix>
  void ApplyToColumns(Matrix* A) const {
    for (Eigen::Index j = 0; j < A->cols(); ++j) {
      auto column = A->col(j);
      ApplyTo(&column);
    }
  }

  /// S v in the place of v.
  template <typename Vector>
  void ApplyTo(Vector* v) const {
    const typename Vector::PlainObject before = *v;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double sum = 0.0;
      for (std::size_t e = BeginOf(r); e < ends_[r]; ++e) {
        sum += elements_[e].value * before(elements_[e].column);
      }
      (*v)(rows_[r]) = sum;
    }
  }

  /// S P S' in the place of P, symmetric to the last bit if P is. P is column-major.
  template <typename Matrix>
  void ApplyCongruence(Matrix* P) const {
    static_assert(!Matrix::IsRowMajor);
    const auto count = static_cast<Eigen::Index>(rows_.size());
    Matrix PSt(P->rows(), count);
    AddUp(*P, /*lower=*/false, &PSt);
    const Matrix SP = PSt.transpose();
    Matrix both(count, count);
    AddUp(SP, /*lower=*/true, &both);
    for (Eigen::Index j = 0; j < P->cols(); ++j) {
      for (Eigen::Index r = 0; r < count; ++r) {
        (*P)(rows_[static_cast<std::size_t>(r)], j) = SP(r, j);
      }
    }
    for (Eigen::Index r = 0; r < count; ++r) {
      const Eigen::Index j = rows_[static_cast<std::size_t>(r)];
      P->col(j) = PSt.col(r);
    }
    for (Eigen::Index r = 0; r < count; ++r) {
      const Eigen::Index j = rows_[static_cast<std::size_t>(r)];
      for (Eigen::Index s = r; s < count; ++s) {
        const Eigen::Index i = rows_[static_cast<std::size_t>(s)];
        (*P)(i, j) = (*P)(j, i) = both(s, r);
      }
    }
  }

 private:
  struct Element {
    Eigen::Index column;
    double value;
  };

  std::size_t BeginOf(std::size_t row) const {
    return row > 0 ? ends_[row - 1] : 0;
  }

  /// out = A S', of the rows of S that are not of the identity; `lower` asks for no
  /// element above the diagonal.
  template <typename Matrix>
  void AddUp(const Matrix& A, bool lower, Matrix* out) const {
    constexpr Eigen::Index kStrip = 8;
    const Eigen::Index rows = A.rows();
    for (Eigen::Index j = 0; j < out->cols(); ++j) {
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
    for (std::size_t e = BeginOf(row); e < ends_[row]; ++e) {
      const double* column =
          A.data() + elements_[e].column * A.outerStride() + first;
      sum += elements_[e].value * Eigen::Map<const Strip>(column);
    }
    Eigen::Map<Strip>(out->data() + j * out->outerStride() + first) = sum;
  }

  std::vector<Eigen::Index> rows_;  ///< that are not of the identity
  std::vector<Element> elements_;   ///< of these, row by row
  std::vector<std::size_t> ends_;   ///< of each of them in elements_
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
