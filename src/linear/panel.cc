#include "linear/panel.h"

namespace hindsight {
namespace {

using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

void DivideByFactor(double* F, int rows, int n, const double* panel, int height,
                    const double* inverse_diagonal) {
  for (int j = n - 1; j >= 0; --j) {
    double* column = F + static_cast<Eigen::Index>(j) * rows;
    SubtractColumns(
        column, rows,
        {column + rows, rows,
         panel + static_cast<Eigen::Index>(j) * height + j + 1, 1, n - 1 - j});
    VectorMap(column, rows) *= inverse_diagonal[j];
  }
}

void SolveBackward(const double* panel, int height, int n,
                   const double* inverse_diagonal, double* work) {
  for (int j = n - 1; j >= 0; --j) {
    const int below = height - j - 1;
    const double known =
        ConstVectorMap(panel + static_cast<Eigen::Index>(j) * height + j + 1,
                       below)
            .dot(ConstVectorMap(work + j + 1, below));
    work[j] = (work[j] - known) * inverse_diagonal[j];
  }
}

}  // namespace hindsight
