#ifndef HINDSIGHT_LINEAR_HOUSEHOLDER_H_
#define HINDSIGHT_LINEAR_HOUSEHOLDER_H_

#include <Eigen/Core>
#include <vector>

namespace hindsight {

/// `count` rows of a row-major matrix, `stride` apart.
struct RowRange {
  double* first = nullptr;
  Eigen::Index stride = 0;
  Eigen::Index count = 0;
  double* row(Eigen::Index i) const { return first + i * stride; }
};

/// Norm of column `c` of a row and the rows below it.
double ColumnNorm(const double* top, const RowRange& below, Eigen::Index c);

/// Householder reflections of one row and rows below it (Golub and Van Loan,
/// Matrix Computations, 5.1). Holds work space only.
class Householder {
 public:
  /// Leaves, in column c of the given norm (ColumnNorm), nothing below `top`; over
  /// the columns [c, end). Rows with a zero there cost nothing, and elements whose squares
  /// underflow are taken for zero.
  void Reflect(double* top, const RowRange& below, Eigen::Index c,
               Eigen::Index end, double norm);

 private:
  template <int Columns>
  void ReflectColumns(double* top, double tau, Eigen::Index first);

  std::vector<double*> rows_;
  std::vector<double> v_;  // its element of `top` is 1
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_HOUSEHOLDER_H_
