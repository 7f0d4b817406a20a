#include "linear/arrow_system.h"
#include "linear/panel.h"

// With G = (W; V) L^-1 the rows of a panel below its pivot block, divided by
// its factor, and S the covariance of the unknowns those rows belong to (next
// node and border), the columns of node k of Lambda^-1 are
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

void ArrowSystem::VisitMarginals(const MarginalVisitor& visit) const {
  Require(Phase::kFactored, "VisitMarginals");
  Recursion recursion(n_, m_, node_rows_, border_rows_);
  const auto s_border = scale_.tail(m_);
  Eigen::MatrixXd covariance(n_, n_);
  Eigen::MatrixXd next_node(n_, n_);
  Eigen::MatrixXd border_node(m_, n_);
  const Eigen::MatrixXd border_covariance =
      s_border.cwiseInverse().asDiagonal() * BorderCovariance() *
      s_border.cwiseInverse().asDiagonal();
  recursion.S.block(node_rows_, node_rows_, m_, m_) = border_covariance;
  for (int k = nodes_ - 1; k >= 0; --k) {
    recursion.Step(Panel(k), height_, inverse_diagonal_.data() + k * n_);
    const auto s = scale_.segment(k * n_, n_);
    const int next_rows = k + 1 < nodes_ ? n_ : 0;
    for (int j = 0; j < n_; ++j) {
      covariance.col(j) = recursion.P.col(j).head(n_).cwiseProduct(s) * s(j);
      border_node.col(j) =
          recursion.R.col(j).segment(node_rows_, m_).cwiseProduct(s_border) *
          s(j);
      if (next_rows == 0) continue;
      next_node.col(j) = recursion.R.col(j).head(n_).cwiseProduct(
                             scale_.segment((k + 1) * n_, n_)) *
                         s(j);
    }
    const auto map = [](const Eigen::MatrixXd& M, int rows, int cols) {
      return ConstBlock(M.data(), rows, cols,
                        Eigen::OuterStride<>(M.outerStride()));
    };
    visit({k, map(covariance, n_, n_), map(next_node, next_rows, n_),
           map(border_node, m_, n_)});
  }
}

}  // namespace hindsight
