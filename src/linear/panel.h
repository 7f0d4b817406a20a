#ifndef HINDSIGHT_LINEAR_PANEL_H_
#define HINDSIGHT_LINEAR_PANEL_H_

#include <Eigen/Core>

namespace hindsight {

/// `count` column vectors A(:,i) and as many coefficients.
struct Columns {
  const double* A = nullptr;  ///< column-major, columns on 16-byte boundaries
  Eigen::Index A_stride = 0;
  const double* coefficients = nullptr;
  Eigen::Index coefficient_stride = 1;
  int count = 0;
};

/// out -= sum_i A(:,i) coefficients(i) over a fixed number of rows, which the
/// compiler keeps in registers.
template <int Rows>
inline void SubtractRows(double* out, const Columns& c, Eigen::Index first) {
  using Vector = Eigen::Array<double, Rows, 1>;
  using Input = Eigen::Map<const Vector, Eigen::Aligned16>;
  Eigen::Map<Vector, Eigen::Aligned16> target(out + first);
  Vector sum = target;
  const double* column = c.A + first;
  const double* coefficient = c.coefficients;
  for (int i = 0; i < c.count; ++i) {
    sum -= Input(column) * *coefficient;
    column += c.A_stride;
    coefficient += c.coefficient_stride;
  }
  target = sum;
}

/// Strips should begin at multiples of this many rows.
inline constexpr int kStrip = 8;

/// The same for any even number of rows, in strips of 16, 8, 4 and 2.
inline void SubtractColumns(double* out, int rows, const Columns& c) {
  int first = 0;
  for (; rows - first >= 16; first += 16) SubtractRows<16>(out, c, first);
  if (rows - first >= 8) {
    SubtractRows<8>(out, c, first);
    first += 8;
  }
  if (rows - first >= 4) {
    SubtractRows<4>(out, c, first);
    first += 4;
  }
  if (rows - first >= 2) SubtractRows<2>(out, c, first);
}

/// A panel is a column of blocks, column-major, `height` rows by n columns; its
/// top n x n block is lower triangular, L.

/// F = H L^-1 in place; H has `rows` rows, L is the top of the panel.
void DivideByFactor(double* F, int rows, int n, const double* panel, int height,
                    const double* inverse_diagonal);

/// Top of `work`: L^-T (y - rows below' x_below), with x_below below it.
void SolveBackward(const double* panel, int height, int n,
                   const double* inverse_diagonal, double* work);

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_PANEL_H_
