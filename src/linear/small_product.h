#ifndef HINDSIGHT_LINEAR_SMALL_PRODUCT_H_
#define HINDSIGHT_LINEAR_SMALL_PRODUCT_H_

#include <Eigen/Core>
#include <algorithm>

namespace hindsight {

// Of matrices that the first cache holds, for which the copies that a general
// product makes of its factors take longer than the product. All are column-major.

/// Rows of two columns of A B that the compiler keeps in registers.
template <int Rows, typename Left, typename Right, typename Out>
inline void MultiplyStrip(const Left& A, const Right& B, Eigen::Index first,
                          Eigen::Index j0, Eigen::Index j1, Out* out) {
  using Strip = Eigen::Array<double, Rows, 1>;
  Strip sum0 = Strip::Zero();
  Strip sum1 = Strip::Zero();
  const double* a = A.data() + first;
  const double* b0 = B.data() + j0 * B.colStride();
  const double* b1 = B.data() + j1 * B.colStride();
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    const Strip column = Eigen::Map<const Strip>(a);
    sum0 += column * *b0;
    sum1 += column * *b1;
    a += A.outerStride();
    b0 += B.rowStride();
    b1 += B.rowStride();
  }
  Eigen::Map<Strip>(out->data() + j0 * out->outerStride() + first) = sum0;
  Eigen::Map<Strip>(out->data() + j1 * out->outerStride() + first) = sum1;
}

/// out = A B, of which B may be transposed and A and B parts of others. With
/// `lower` its elements above the diagonal are not said.
template <typename Left, typename Right, typename Out>
void Multiply(const Left& A, const Right& B, bool lower, Out* out) {
  static_assert(!Left::IsRowMajor && !Out::IsRowMajor);
  constexpr int kStrip = 8;
  const Eigen::Index rows = A.rows();
  out->resize(rows, B.cols());
  for (Eigen::Index j = 0; j < B.cols(); j += 2) {
    const Eigen::Index next = std::min(j + 1, B.cols() - 1);
    Eigen::Index i = lower ? j : 0;
    if (rows >= kStrip) {
      for (; i + kStrip < rows; i += kStrip) {
        MultiplyStrip<kStrip>(A, B, i, j, next, out);
      }
      // The last strip may do some rows once more.
      MultiplyStrip<kStrip>(A, B, rows - kStrip, j, next, out);
    } else {
      for (; i < rows; ++i) MultiplyStrip<1>(A, B, i, j, next, out);
    }
  }
}

/// Column `j` of X less its columns from `first` on, as many as there are
/// coefficients, times these.
template <int Rows, typename Matrix, typename Coefficients>
inline void SubtractStrip(Eigen::Index j, Eigen::Index first,
                          const Coefficients& c, Eigen::Index row, Matrix* X) {
  using Strip = Eigen::Array<double, Rows, 1>;
  Eigen::Map<Strip> target(X->data() + j * X->outerStride() + row);
  Strip sum = target;
  const double* column = X->data() + first * X->outerStride() + row;
  for (Eigen::Index k = 0; k < c.size(); ++k) {
    sum -= Eigen::Map<const Strip>(column) * c(k);
    column += X->outerStride();
  }
  target = sum;
}

template <typename Matrix, typename Coefficients>
void SubtractColumnsOf(Eigen::Index j, Eigen::Index first,
                       const Coefficients& c, Matrix* X) {
  Eigen::Index row = 0;
  for (; X->rows() - row >= 8; row += 8) {
    SubtractStrip<8>(j, first, c, row, X);
  }
  if (X->rows() - row >= 4) {
    SubtractStrip<4>(j, first, c, row, X);
    row += 4;
  }
  for (; row < X->rows(); ++row) SubtractStrip<1>(j, first, c, row, X);
}

template <int Rows, typename Wide, typename Matrix>
inline void SubtractSquareStrip(const Wide& W, Eigen::Index row, Matrix* X) {
  using Strip = Eigen::Array<double, Rows, 1>;
  for (Eigen::Index j = 0; j < X->cols(); ++j) {
    Eigen::Map<Strip> target(X->data() + j * X->outerStride() + row);
    Strip sum = target;
    for (Eigen::Index i = 0; i < W.rows(); ++i) {
      sum -= W(i, j) *
             Eigen::Map<const Strip>(W.data() + i * W.outerStride() + row);
    }
    target = sum;
  }
}

/// X - W' W in the place of X, for a W of few rows, which is row-major.
template <typename Wide, typename Matrix>
void SubtractSquare(const Wide& W, Matrix* X) {
  static_assert(Wide::IsRowMajor && !Matrix::IsRowMajor);
  Eigen::Index row = 0;
  for (; X->rows() - row >= 8; row += 8) SubtractSquareStrip<8>(W, row, X);
  if (X->rows() - row >= 4) {
    SubtractSquareStrip<4>(W, row, X);
    row += 4;
  }
  for (; row < X->rows(); ++row) SubtractSquareStrip<1>(W, row, X);
}

/// X (L L')^-1 in its place, L the lower triangle of `factor`.
template <typename Factor, typename Matrix>
void DivideByCholesky(const Factor& factor, Matrix* X) {
  const Eigen::Index n = factor.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    SubtractColumnsOf(j, 0, factor.row(j).head(j), X);
    X->col(j) /= factor(j, j);
  }
  for (Eigen::Index j = n; j-- > 0;) {
    SubtractColumnsOf(j, j + 1, factor.col(j).tail(n - 1 - j), X);
    X->col(j) /= factor(j, j);
  }
}

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_SMALL_PRODUCT_H_
