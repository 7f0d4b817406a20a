#ifndef HINDSIGHT_LINEAR_ROW_PRODUCTS_H_
#define HINDSIGHT_LINEAR_ROW_PRODUCTS_H_

#include <Eigen/Core>

namespace hindsight {

/// `rows` rows of a row-major matrix, `columns` of its columns.
struct RowSpan {
  const double* first = nullptr;
  Eigen::Index stride = 0;  ///< from row to row
  int rows = 0;
  int columns = 0;
};

/// out += A' B, in a column-major `out` whose columns are `out_stride` apart; A
/// and B have equally many rows. What B has of zeros costs nothing, as most of
/// the Jacobian of a measurement is.
inline void AddTransposedProduct(const RowSpan& A, const RowSpan& B,
                                 double* out, Eigen::Index out_stride) {
  for (int r = 0; r < A.rows; ++r) {
    const double* a = A.first + r * A.stride;
    const double* b = B.first + r * B.stride;
    for (int j = 0; j < B.columns; ++j) {
      const double factor = b[j];
      if (factor == 0.0) continue;
      double* column = out + j * out_stride;
      for (int i = 0; i < A.columns; ++i) column[i] += a[i] * factor;
    }
  }
}

/// The lower triangle alone of out += A' A.
inline void AddSquare(const RowSpan& A, double* out, Eigen::Index out_stride) {
  for (int r = 0; r < A.rows; ++r) {
    const double* a = A.first + r * A.stride;
    for (int j = 0; j < A.columns; ++j) {
      const double factor = a[j];
      if (factor == 0.0) continue;
      double* column = out + j * out_stride;
      for (int i = j; i < A.columns; ++i) column[i] += a[i] * factor;
    }
  }
}

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_ROW_PRODUCTS_H_
