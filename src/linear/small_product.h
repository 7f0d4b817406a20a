#ifndef HINDSIGHT_LINEAR_SMALL_PRODUCT_H_
#define HINDSIGHT_LINEAR_SMALL_PRODUCT_H_

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>

namespace hindsight {

// Of matrices that the first cache holds, for which the copies that a general
// product makes of its factors take longer than the product. All are column-major.

/// All of the columns of A and rows of B that a product adds up.
struct WholeInside {
  Eigen::Index count;
  Eigen::Index size() const { return count; }
  Eigen::Index operator[](Eigen::Index i) const { return i; }
};

/// Those of a B of up to kMost rows of which either of two columns has an element
/// that is not zero.
class NonzeroInside {
 public:
  static constexpr Eigen::Index kMost = 16;

  template <typename Right>
  NonzeroInside(const Right& B, Eigen::Index j0, Eigen::Index j1) {
    const double* b0 = B.data() + j0 * B.colStride();
    const double* b1 = B.data() + j1 * B.colStride();
    // No branch, which no processor would guess, and the count in a register.
    Eigen::Index size = 0;
    for (Eigen::Index k = 0; k < B.rows(); ++k) {
      rows_[size] = k;
      const std::uint64_t bits =
          std::bit_cast<std::uint64_t>(*b0) | std::bit_cast<std::uint64_t>(*b1);
      size += static_cast<Eigen::Index>((bits << 1) != 0);  // but for the sign
      b0 += B.rowStride();
      b1 += B.rowStride();
    }
    size_ = size;
  }
  Eigen::Index size() const { return size_; }
  Eigen::Index operator[](Eigen::Index i) const { return rows_[i]; }

 private:
  Eigen::Index rows_[kMost];
  Eigen::Index size_ = 0;
};

/// Rows of two columns of A B that the compiler keeps in registers.
template <int Rows, typename Left, typename Right, typename Inside,
          typename Out>
inline void MultiplyStrip(const Left& A, const Right& B, const Inside& inside,
                          Eigen::Index first, Eigen::Index j0, Eigen::Index j1,
                          Out* out) {
  using Strip = Eigen::Array<double, Rows, 1>;
  Strip sum0 = Strip::Zero();
  Strip sum1 = Strip::Zero();
  const double* a = A.data() + first;
  const double* b0 = B.data() + j0 * B.colStride();
  const double* b1 = B.data() + j1 * B.colStride();
  for (Eigen::Index i = 0; i < inside.size(); ++i) {
    const Eigen::Index k = inside[i];
    const Strip column = Eigen::Map<const Strip>(a + k * A.outerStride());
    sum0 += column * b0[k * B.rowStride()];
    sum1 += column * b1[k * B.rowStride()];
  }
  Eigen::Map<Strip>(out->data() + j0 * out->outerStride() + first) = sum0;
  Eigen::Map<Strip>(out->data() + j1 * out->outerStride() + first) = sum1;
}

/// Two columns of A B from row `i` on at the least.
template <typename Left, typename Right, typename Inside, typename Out>
inline void MultiplyColumns(const Left& A, const Right& B, const Inside& inside,
                            Eigen::Index i, Eigen::Index j0, Eigen::Index j1,
                            Out* out) {
  const Eigen::Index rows = A.rows();
  if (rows >= 8) {
    for (; i + 8 < rows; i += 8) {
      MultiplyStrip<8>(A, B, inside, i, j0, j1, out);
    }
    // The last strip may do some rows once more.
    if (i + 4 < rows) {
      MultiplyStrip<8>(A, B, inside, rows - 8, j0, j1, out);
    } else {
      MultiplyStrip<4>(A, B, inside, rows - 4, j0, j1, out);
    }
  } else if (rows >= 4) {
    if (i + 4 < rows) MultiplyStrip<4>(A, B, inside, i, j0, j1, out);
    MultiplyStrip<4>(A, B, inside, rows - 4, j0, j1, out);
  } else {
    for (; i < rows; ++i) MultiplyStrip<1>(A, B, inside, i, j0, j1, out);
  }
}

/// out = A B, of which B may be transposed and A and B parts of others. With
/// `lower` its elements above the diagonal are not said.
template <typename Left, typename Right, typename Out>
void Multiply(const Left& A, const Right& B, bool lower, Out* out) {
  static_assert(!Left::IsRowMajor && !Out::IsRowMajor);
  out->resize(A.rows(), B.cols());
  for (Eigen::Index j = 0; j < B.cols(); j += 2) {
    MultiplyColumns(A, B, WholeInside{A.cols()}, lower ? j : 0, j,
                    std::min(j + 1, B.cols() - 1), out);
  }
}

/// out = A B for a B of up to NonzeroInside::kMost rows and many zeros, which it
/// passes over.
template <typename Left, typename Right, typename Out>
void MultiplyBySparse(const Left& A, const Right& B, Out* out) {
  static_assert(!Left::IsRowMajor && !Out::IsRowMajor);
  out->resize(A.rows(), B.cols());
  for (Eigen::Index j = 0; j < B.cols(); j += 2) {
    const Eigen::Index next = std::min(j + 1, B.cols() - 1);
    MultiplyColumns(A, B, NonzeroInside(B, j, next), 0, j, next, out);
  }
}

/// Rows of two columns of `out` and of A B, of few columns of A: out + Sign A B.
template <int Rows, int Sign, typename Left, typename Right, typename Out>
inline void AddStrip(const Left& A, const Right& B, Eigen::Index first,
                     Eigen::Index j0, Eigen::Index j1, Out* out) {
  using Strip = Eigen::Array<double, Rows, 1>;
  Strip sum0 = Strip::Zero();
  Strip sum1 = Strip::Zero();
  const double* a = A.data() + first;
  const double* b0 = B.data() + j0 * B.colStride();
  const double* b1 = B.data() + j1 * B.colStride();
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    const Strip column = Eigen::Map<const Strip>(a + k * A.outerStride());
    sum0 += column * b0[k * B.rowStride()];
    sum1 += column * b1[k * B.rowStride()];
  }
  Eigen::Map<Strip> out0(out->data() + j0 * out->outerStride() + first);
  Eigen::Map<Strip> out1(out->data() + j1 * out->outerStride() + first);
  const Strip new0 = Sign > 0 ? Strip(out0 + sum0) : Strip(out0 - sum0);
  const Strip new1 = Sign > 0 ? Strip(out1 + sum1) : Strip(out1 - sum1);
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
