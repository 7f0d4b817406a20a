#ifndef HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
#define HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
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
/// rows that S has not are those of the identity. S has 255 rows at most.
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
    const std::size_t first = values_.size();
    const std::size_t header = index_.size();
    index_.resize(header + 2);
    for (Eigen::Index j = begin; j < end; ++j) {
      const double value = of(j);
      if (value == 0.0) continue;
      values_.push_back(value);
      index_.push_back(static_cast<std::uint8_t>(j));
    }
    const std::size_t count = values_.size() - first;
    const bool is_of_identity =
        count == 1 && index_.back() == i && values_.back() == 1.0;
    if (is_of_identity) {
      values_.pop_back();
      index_.resize(header);
      return;
    }
    index_[header] = static_cast<std::uint8_t>(i);
    index_[header + 1] = static_cast<std::uint8_t>(count);
    ++rows_;
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
    Row row = FirstRow();
    for (Eigen::Index r = 0; r < rows_; ++r, row = RowAfter(row)) {
      double sum = 0.0;
      for (std::size_t e = 0; e < row.count; ++e) {
        sum += row.values[e] * before(row.columns[e]);
      }
      (*v)(row.row) = sum;
    }
  }

  /// S P S' in the place of P, symmetric to the last bit if P is. P is column-major.
  template <typename Matrix>
  void ApplyCongruence(Matrix* P) const {
    static_assert(!Matrix::IsRowMajor);
    Matrix PSt(P->rows(), rows_);
    AddUp(*P, /*lower=*/false, &PSt);
    const Matrix SP = PSt.transpose();
    Matrix both(rows_, rows_);
    AddUp(SP, /*lower=*/true, &both);
    std::array<Eigen::Index, kMostRows> rows;
    Row row = FirstRow();
    for (Eigen::Index r = 0; r < rows_; ++r, row = RowAfter(row)) {
      rows[static_cast<std::size_t>(r)] = row.row;
    }
    const auto of = [&rows](Eigen::Index r) {
      return rows[static_cast<std::size_t>(r)];
    };
    for (Eigen::Index j = 0; j < P->cols(); ++j) {
      for (Eigen::Index r = 0; r < rows_; ++r) (*P)(of(r), j) = SP(r, j);
    }
    for (Eigen::Index r = 0; r < rows_; ++r) P->col(of(r)) = PSt.col(r);
    for (Eigen::Index r = 0; r < rows_; ++r) {
      for (Eigen::Index s = r; s < rows_; ++s) {
        (*P)(of(s), of(r)) = (*P)(of(r), of(s)) = both(s, r);
      }
    }
  }

 private:
  /// As many as a byte can count.
  static constexpr std::size_t kMostRows = 255;

  struct Row {
    Eigen::Index row;
    std::size_t count;  ///< of elements
    const std::uint8_t* columns;
    const double* values;
  };

  static Row RowAt(const std::uint8_t* index, const double* values) {
    return {index[0], index[1], index + 2, values};
  }
  Row FirstRow() const {
    return rows_ > 0 ? RowAt(index_.data(), values_.data()) : Row{};
  }
  /// After the last one that is empty.
  Row RowAfter(const Row& row) const {
    const std::uint8_t* next = row.columns + row.count;
    return next < index_.data() + index_.size()
               ? RowAt(next, row.values + row.count)
               : Row{};
  }

  /// out = A S', of the rows of S that are not of the identity; `lower` asks for no
  /// element above the diagonal.
  template <typename Matrix>
  void AddUp(const Matrix& A, bool lower, Matrix* out) const {
    constexpr Eigen::Index kStrip = 8;
    const Eigen::Index rows = A.rows();
    Row row = FirstRow();
    for (Eigen::Index j = 0; j < rows_; ++j, row = RowAfter(row)) {
      Eigen::Index i = lower ? j : 0;
      if (rows < kStrip) {
        for (; i < rows; ++i) AddUpStrip<1>(A, i, row, j, out);
        continue;
      }
      for (; i + kStrip < rows; i += kStrip) {
        AddUpStrip<kStrip>(A, i, row, j, out);
      }
      // The last strip may do some rows once more.
      AddUpStrip<kStrip>(A, rows - kStrip, row, j, out);
    }
  }

  /// Rows from `first` on of column j of the result, kept in registers.
  template <int Rows, typename Matrix>
  static void AddUpStrip(const Matrix& A, Eigen::Index first, const Row& row,
                         Eigen::Index j, Matrix* out) {
    using Strip = Eigen::Array<double, Rows, 1>;
    Strip sum = Strip::Zero();
    for (std::size_t e = 0; e < row.count; ++e) {
      const double* column =
          A.data() + row.columns[e] * A.outerStride() + first;
      sum += row.values[e] * Eigen::Map<const Strip>(column);
    }
    Eigen::Map<Strip>(out->data() + j * out->outerStride() + first) = sum;
  }

  Eigen::Index rows_ = 0;  ///< that are not of the identity
  /// Of each of them row, number of elements and the columns of these.
  std::vector<std::uint8_t> index_;
  std::vector<double> values_;  ///< of the elements, row by row
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_SPARSE_PRODUCT_H_
