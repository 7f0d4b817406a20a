#include "linear/panel.h"

#include <cmath>

namespace hindsight {
namespace {

using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

void FactorPanel(double* panel, int height, int n, double tolerance, int node,
                 double* inverse_diagonal, std::vector<Deficiency>* deficient) {
  for (int j = 0; j < n; ++j) {
    double* column = panel + static_cast<Eigen::Index>(j) * height;
    const int first = j - j % kStrip;
    SubtractColumns(column + first, height - first,
                    {panel + first, height, panel + j, height, j});
    const double pivot = column[j];
    const bool positive = pivot > tolerance;
    if (!positive) deficient->push_back({node, j, pivot});
    const double inverse = positive ? 1.0 / std::sqrt(pivot) : 0.0;
    inverse_diagonal[j] = inverse;
    VectorMap below(column + j, height - j);
    if (positive) {
      below *= inverse;
    } else {
      below.setZero();
    }
    VectorMap(column, j).setZero();
  }
}

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

void SolveForward(const double* panel, int height, int n,
                  const double* inverse_diagonal, double* work) {
  for (int j = 0; j < n; ++j) {
    work[j] *= inverse_diagonal[j];
    const int below = height - j - 1;
    VectorMap(work + j + 1, below) -=
        work[j] *
        ConstVectorMap(panel + static_cast<Eigen::Index>(j) * height + j + 1,
                       below);
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
