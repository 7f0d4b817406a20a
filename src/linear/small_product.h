#ifndef HINDSIGHT_LINEAR_SMALL_PRODUCT_H_
#define HINDSIGHT_LINEAR_SMALL_PRODUCT_H_

#include <Eigen/Core>
#include <algorithm>

namespace hindsight {

// Of matrices that the first cache holds, for which the copies that a general
// product makes of its factors take longer than the product. All are column-major.

/// Rows of two columns of a product, which the compiler keeps in registers.
template <int Rows>
struct TwoStrips {
  using Strip = Eigen::Array<double, Rows, 1>;
  Strip first = Strip::Zero();
  Strip second = Strip::Zero();
};

/// Of columns j0 and j1 of A B, from row `from` on.
template <int Rows, typename Left, typename Right>
inline TwoStrips<Rows> StripsOf(const Left& A, const Right& B,
                                Eigen::Index from, Eigen::Index j0,
                                Eigen::Index j1) {
  using Strip = typename TwoStrips<Rows>::Strip;
  TwoStrips<Rows> sum;
  const double* a = A.data() + from;
  const double* b0 = B.data() + j0 * B.colStride();
  const double* b1 = B.data() + j1 * B.colStride();
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    const Strip column = Eigen::Map<const Strip>(a);
    sum.first += column * *b0;
    sum.second += column * *b1;
    a += A.outerStride();
    b0 += B.rowStride();
    b1 += B.rowStride();
  }
  return sum;
}

template <int Rows, typename Left, typename Right, typename Out>
inline void MultiplyStrip(const Left& A, const Right& B, Eigen::Index first,
                          Eigen::Index j0, Eigen::Index j1, Out* out) {
  using Strip = typename TwoStrips<Rows>::Strip;
  const TwoStrips<Rows> sum = StripsOf<Rows>(A, B, first, j0, j1);
  Eigen::Map<Strip>(out->data() + j0 * out->outerStride() + first) = sum.first;
  Eigen::Map<Strip>(out->data() + j1 * out->outerStride() + first) = sum.second;
}

/// Two columns of A B from row `i` on at the least.
template <typename Left, typename Right, typename Out>
inline void MultiplyColumns(const Left& A, const Right& B, Eigen::Index i,
                            Eigen::Index j0, Eigen::Index j1, Out* out) {
  const Eigen::Index rows = A.rows();
  if (rows >= 8) {
    for (; i + 8 < rows; i += 8) {
      MultiplyStrip<8>(A, B, i, j0, j1, out);
    }
    // The last strip may do some rows once more.
    if (i + 4 < rows) {
      MultiplyStrip<8>(A, B, rows - 8, j0, j1, out);
    } else {
      MultiplyStrip<4>(A, B, rows - 4, j0, j1, out);
    }
  } else if (rows >= 4) {
    if (i + 4 < rows) MultiplyStrip<4>(A, B, i, j0, j1, out);
    MultiplyStrip<4>(A, B, rows - 4, j0, j1, out);
  } else {
    for (; i < rows; ++i) MultiplyStrip<1>(A, B, i, j0, j1, out);
  }
}

/// out = A B, of which B may be transposed and A and B parts of others. With
/// `lower` its elements above the diagonal are not said.
template <typename Left, typename Right, typename Out>
void Multiply(const Left& A, const Right& B, bool lower, Out* out) {
  static_assert(!Left::IsRowMajor && !Out::IsRowMajor);
  out->resize(A.rows(), B.cols());
  for (Eigen::Index j = 0; j < B.cols(); j += 2) {
    MultiplyColumns(A, B, lower ? j : 0, j, std::min(j + 1, B.cols() - 1), out);
  }
}

/// Rows of two columns of `out` and of A B, of few columns of A: out + Sign A B.
template <int Rows, int Sign, typename Left, typename Right, typename Out>
inline void AddStrip(const Left& A, const Right& B, Eigen::Index first,
                     Eigen::Index j0, Eigen::Index j1, Out* out) {
  using Strip = typename TwoStrips<Rows>::Strip;
  const TwoStrips<Rows> sum = StripsOf<Rows>(A, B, first, j0, j1);
  Eigen::Map<Strip> out0(out->data() + j0 * out->outerStride() + first);
  Eigen::Map<Strip> out1(out->data() + j1 * out->outerStride() + first);
  const Strip new0 =
      Sign > 0 ? Strip(out0 + sum.first) : Strip(out0 - sum.first);
  const Strip new1 =
      Sign > 0 ? Strip(out1 + sum.second) : Strip(out1 - sum.second);
  out0 = new0;
  out1 = new1;
}

/// out + Sign A B in the place of `out`, for an A of few columns. B may be
/// transposed, and each of them a part of another.
template <int Sign, typename Left, typename Right, typename Out>
void AddProduct(const Left& A, const Right& B, Out* out) {
  static_assert(!Left::IsRowMajor && !Out::IsRowMajor);
  const Eigen::Index rows = A.rows();
  for (Eigen::Index j = 0; j < B.cols(); j += 2) {
    const Eigen::Index next = std::min(j + 1, B.cols() - 1);
    Eigen::Index i = 0;
    for (; rows - i >= 8; i += 8) AddStrip<8, Sign>(A, B, i, j, next, out);
    if (rows - i >= 4) {
      AddStrip<4, Sign>(A, B, i, j, next, out);
      i += 4;
    }
    if (rows - i >= 2) {
      AddStrip<2, Sign>(A, B, i, j, next, out);
      i += 2;
    }
    if (i < rows) AddStrip<1, Sign>(A, B, i, j, next, out);
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
  if (X->rows() - row >= 2) {
    SubtractStrip<2>(j, first, c, row, X);
    row += 2;
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
