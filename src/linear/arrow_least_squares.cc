#include "linear/arrow_least_squares.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "linear/panel.h"

namespace hindsight {
namespace {

using RowMatrix = ArrowLeastSquares::RowMatrix;

int Even(int x) { return x + (x & 1); }

/// Room for `rows`, what is there kept.
void Reserve(Eigen::Index rows, RowMatrix* work) {
  if (work->rows() >= rows) return;
  work->conservativeResize(2 * rows, Eigen::NoChange);
}

}  // namespace

ArrowLeastSquares::ArrowLeastSquares(int nodes, int node_dim, int border_dim,
                                     double tolerance)
    : nodes_(nodes),
      n_(node_dim),
      m_(border_dim),
      tolerance_(tolerance),
      node_rows_(Even(node_dim)),
      border_rows_(Even(border_dim)),
      height_(2 * node_rows_ + border_rows_) {
  if (nodes < 1 || node_dim < 1 || border_dim < 0) {
    throw std::logic_error("arrow needs a node and an unknown");
  }
  const int width = 2 * n_ + m_ + 1;
  node_work_.resize(2 * (n_ + m_), width);
  link_work_.resize(2 * n_, width);
  border_work_ = RowMatrix::Zero(m_, m_ + 1);
  node_norm_ = Eigen::RowVectorXd::Zero(n_);
  next_norm_ = Eigen::RowVectorXd::Zero(n_);
  border_norm_ = Eigen::RowVectorXd::Zero(m_);
  panels_ = PagedRows(static_cast<std::size_t>(nodes),
                      static_cast<std::size_t>(height_ * n_));
  border_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(border_rows_) * m_);
  const Eigen::Index unknowns = static_cast<Eigen::Index>(nodes) * n_ + m_;
  solution_ = Eigen::VectorXd::Zero(unknowns);
  inverse_diagonal_ = Eigen::VectorXd::Zero(unknowns);
}

void ArrowLeastSquares::Require(Phase phase, const char* call) const {
  if (phase_ != phase) {
    throw std::logic_error(std::string("arrow: ") + call +
                           (phase == Phase::kSolved ? " before" : " after") +
                           " Solve");
  }
}

ArrowLeastSquares::Rows ArrowLeastSquares::Add(int k, int count,
                                               RowMatrix* rows,
                                               Eigen::Index* used) {
  Require(Phase::kFilling, "rows");
  if (k < filled_ || k >= nodes_ || count < 0) {
    throw std::logic_error("arrow: rows of node " + std::to_string(k) +
                           " after those of node " + std::to_string(filled_));
  }
  while (filled_ < k) EliminateNode();
  const Eigen::Index first = *used;
  *used += count;
  Reserve(*used, rows);
  rows->middleRows(first, count).setZero();
  return {rows, first, count, n_, m_};
}

ArrowLeastSquares::Rows ArrowLeastSquares::AddToNode(int k, int count) {
  return Add(k, count, &node_work_, &node_used_);
}

ArrowLeastSquares::Rows ArrowLeastSquares::AddToLink(int k, int count) {
  if (k + 1 >= nodes_) throw std::logic_error("arrow: no node after the last");
  return Add(k, count, &link_work_, &link_used_);
}

void ArrowLeastSquares::CountNorms() {
  node_norm_ = next_norm_;
  const auto here = node_work_.middleRows(carried_, node_used_ - carried_);
  const auto link = link_work_.topRows(link_used_);
  node_norm_ += here.leftCols(n_).colwise().squaredNorm() +
                link.leftCols(n_).colwise().squaredNorm();
  next_norm_ = link.rightCols(n_).colwise().squaredNorm();
  border_norm_ += here.middleCols(n_, m_).colwise().squaredNorm() +
                  link.middleCols(n_, m_).colwise().squaredNorm();
}

bool ArrowLeastSquares::IsFixed(Eigen::Index j, double left) {
  const double fraction = left / std::sqrt(node_norm_(j));
  if (fraction > tolerance_) return false;
  deficient_.push_back(
      {filled_, static_cast<int>(j), node_norm_(j) > 0.0 ? fraction : 0.0});
  return true;
}

void ArrowLeastSquares::PassOn(Eigen::Index j, RowMatrix* to,
                               Eigen::Index* used) {
  to->row((*used)++) = node_work_.row(j);
  node_work_.row(j).setZero();
}

void ArrowLeastSquares::EliminateNode() {
  CountNorms();
  // Room for the rows of unknowns that are held fixed.
  Reserve(std::max<Eigen::Index>(node_used_, n_) + n_, &node_work_);
  Reserve(link_used_ + n_, &link_work_);
  while (node_used_ < n_) node_work_.row(node_used_++).setZero();
  node_work_.topRows(n_).rightCols(n_).setZero();
  TriangulariseNode();
  GiveToBorder();
  TakeLink();
  Carry();
}

void ArrowLeastSquares::TriangulariseNode() {
  const bool last = filled_ + 1 == nodes_;
  const Eigen::Index width = node_work_.cols();
  for (Eigen::Index j = 0; j < n_; ++j) {
    double* top = node_work_.row(j).data();
    const RowRange below{top + width, width, node_used_ - j - 1};
    const double left = ColumnNorm(top, below, j);
    if (last && IsFixed(j, left)) {
      node_work_.block(j, j, node_used_ - j, 1).setZero();
      PassOn(j, &node_work_, &node_used_);
      continue;
    }
    householder_.Reflect(top, below, j, n_ + m_ + 1, left);
  }
}

void ArrowLeastSquares::GiveToBorder() {
  for (Eigen::Index j = 0; j < m_; ++j) {
    double* top = border_work_.row(j).data();
    const RowRange below{node_work_.row(n_).data() + n_, node_work_.cols(),
                         node_used_ - n_};
    householder_.Reflect(top, below, j, m_ + 1, ColumnNorm(top, below, j));
  }
}

void ArrowLeastSquares::TakeLink() {
  const bool last = filled_ + 1 == nodes_;
  const Eigen::Index width = node_work_.cols();
  const Eigen::Index alone = n_ + m_ + 1;
  double* const inverse = inverse_diagonal_.data() + filled_ * n_;
  for (Eigen::Index j = 0; j < n_; ++j) {
    double* top = node_work_.row(j).data();
    const RowRange below{link_work_.data(), width, last ? 0 : link_used_};
    const double left = ColumnNorm(top, below, j);
    if (!last && IsFixed(j, left)) {
      top[j] = 0.0;
      link_work_.col(j).head(link_used_).setZero();
      PassOn(j, &link_work_, &link_used_);
      continue;
    }
    if (left == 0.0) continue;
    householder_.Reflect(top, below, j, width, left);
    inverse[j] = 1.0 / top[j];
    solution_(filled_ * n_ + j) = -top[n_ + m_];
    double* column = Panel(filled_) + j * height_;
    std::copy(top + j, top + n_, column + j);
    std::copy(top + alone, top + width, column + node_rows_);
    std::copy(top + n_, top + n_ + m_, column + 2 * node_rows_);
  }
}

void ArrowLeastSquares::Carry() {
  ++filled_;
  carried_ = node_used_ = link_used_;
  link_used_ = 0;
  Reserve(carried_, &node_work_);
  const auto from = link_work_.topRows(carried_);
  auto to = node_work_.topRows(carried_);
  to.leftCols(n_) = from.rightCols(n_);
  to.middleCols(n_, m_ + 1) = from.middleCols(n_, m_ + 1);
}

void ArrowLeastSquares::EliminateBorder() {
  // Rows of unknowns that are held fixed go on below.
  Reserve(2 * m_, &border_work_);
  Eigen::Index used = m_;
  double* const inverse = inverse_diagonal_.data() + nodes_ * n_;
  for (Eigen::Index j = 0; j < m_; ++j) {
    double* top = border_work_.row(j).data();
    const RowRange below{border_work_.row(m_).data(), m_ + 1, used - m_};
    const double left = ColumnNorm(top, below, j);
    const double fraction = left / std::sqrt(border_norm_(j));
    if (!(fraction > tolerance_)) {
      deficient_.push_back({Deficiency::kBorder, static_cast<int>(j),
                            border_norm_(j) > 0.0 ? fraction : 0.0});
      border_work_.row(used) = border_work_.row(j);
      border_work_.row(j).setZero();
      ++used;
      border_work_.block(m_, j, used - m_, 1).setZero();
      continue;
    }
    householder_.Reflect(top, below, j, m_ + 1, left);
    inverse[j] = 1.0 / top[j];
    solution_(nodes_ * n_ + j) = -top[m_];
    std::copy(top + j, top + m_, border_.data() + j * border_rows_ + j);
  }
}

std::vector<Deficiency> ArrowLeastSquares::Solve() {
  Require(Phase::kFilling, "Solve");
  while (filled_ < nodes_) EliminateNode();
  EliminateBorder();
  phase_ = Phase::kSolved;
  // Rows of a panel: this node, the next, the border.
  Eigen::VectorXd work = Eigen::VectorXd::Zero(height_);
  auto here = work.head(n_);
  auto next = work.segment(node_rows_, n_);
  auto border = work.segment(2 * node_rows_, m_);
  border = solution_.tail(m_);
  if (m_ > 0) {
    SolveBackward(border_.data(), border_rows_, m_,
                  inverse_diagonal_.data() + nodes_ * n_,
                  work.data() + 2 * node_rows_);
  }
  for (int k = nodes_ - 1; k >= 0; --k) {
    here = solution_.segment(k * n_, n_);
    SolveBackward(Panel(k), height_, n_, inverse_diagonal_.data() + k * n_,
                  work.data());
    solution_.segment(k * n_, n_) = here;
    next = here;
  }
  solution_.tail(m_) = border;
  return deficient_;
}

Eigen::MatrixXd ArrowLeastSquares::BorderCovariance() const {
  Require(Phase::kSolved, "BorderCovariance");
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(border_rows_, m_);
  if (m_ == 0) return Eigen::MatrixXd(0, 0);
  DivideByFactor(inverse.data(), border_rows_, m_, border_.data(), border_rows_,
                 inverse_diagonal_.data() + nodes_ * n_);
  return inverse.topRows(m_).transpose() * inverse.topRows(m_);
}

}  // namespace hindsight
