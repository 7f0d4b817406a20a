#include "linear/arrow_least_squares.h"
#include "linear/panel.h"

// With L' the node's part of R, G = (W; V) L^-1 its rows for the next node and
// the border divided by it, and S the covariance of those unknowns, the columns
// of node k of (R'R)^-1 are
//   below the diagonal  -S G,    on it  L^-T L^-1 + G' S G.

namespace hindsight {
namespace {

/// Work space of the backward recursion; leading dimensions are even.
struct Recursion {
  Recursion(int n, int m, int node_rows, int border_rows)
      : n(n),
        m(m),
        node_rows(node_rows),
        below_rows(node_rows + border_rows),
        rows(below_rows + node_rows),
        S(Eigen::MatrixXd::Zero(below_rows, below_rows)),
        F(Eigen::MatrixXd::Zero(rows, n)),
        F_transposed(Eigen::MatrixXd::Zero(node_rows, rows)),
        R(Eigen::MatrixXd::Zero(rows, n)),
        P(Eigen::MatrixXd::Zero(node_rows, n)) {}

  void Step(const double* panel, int height, const double* inverse_diagonal);

  int n, m, node_rows, below_rows, rows;
  Eigen::MatrixXd S;             // covariance of next node and border
  Eigen::MatrixXd F;             // (G; L^-1)
  Eigen::MatrixXd F_transposed;  // kept so that the kernel reads columns
  Eigen::MatrixXd R;             // (-S G; -L^-1)
  Eigen::MatrixXd P;             // covariance of the node
};

void Recursion::Step(const double* panel, int height,
                     const double* inverse_diagonal) {
  const Eigen::Map<const Eigen::MatrixXd> columns(panel, height, n);
  F.topRows(below_rows) = columns.bottomRows(below_rows);
  F.bottomRows(node_rows).setIdentity();
  DivideByFactor(F.data(), rows, n, panel, height, inverse_diagonal);
  F_transposed.topRows(n) = F.transpose();
  R.topRows(below_rows).setZero();
  R.bottomRows(node_rows) = -F.bottomRows(node_rows);
  P.setZero();
  for (int j = 0; j < n; ++j) {
    SubtractColumns(R.col(j).data(), below_rows,
                    {S.data(), below_rows, F.col(j).data(), 1, below_rows});
    const int first = j - j % kStrip;
    SubtractColumns(
        P.col(j).data() + first, node_rows - first,
        {F_transposed.data() + first, node_rows, R.col(j).data(), 1, rows});
  }
  for (int j = 1; j < n; ++j) P.col(j).head(j) = P.row(j).head(j).transpose();
  S.topLeftCorner(node_rows, n) = P;
  S.block(node_rows, 0, m, n) = R.block(node_rows, 0, m, n);
  S.block(0, node_rows, n, m) = R.block(node_rows, 0, m, n).transpose();
}

}  // namespace

void ArrowLeastSquares::VisitMarginals(const MarginalVisitor& visit) const {
  Require(Phase::kSolved, "VisitMarginals");
  Recursion recursion(n_, m_, node_rows_, border_rows_);
  recursion.S.block(node_rows_, node_rows_, m_, m_) = BorderCovariance();
  const auto block = [](const Eigen::MatrixXd& M, int row, int rows, int cols) {
    return ConstBlock(M.data() + row, rows, cols,
                      Eigen::OuterStride<>(M.outerStride()));
  };
  for (int k = nodes_ - 1; k >= 0; --k) {
    recursion.Step(Panel(k), height_, inverse_diagonal_.data() + k * n_);
    visit({k, block(recursion.P, 0, n_, n_),
           block(recursion.R, 0, k + 1 < nodes_ ? n_ : 0, n_),
           block(recursion.R, node_rows_, m_, n_)});
  }
}

}  // namespace hindsight
