#include "linear/arrow_system.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "linear/panel.h"

namespace hindsight {
namespace {

int Even(int x) { return x + (x & 1); }

double UnitScale(double diagonal) {
  return diagonal > 0.0 && std::isfinite(diagonal) ? 1.0 / std::sqrt(diagonal)
                                                   : 1.0;
}

}  // namespace

ArrowSystem::ArrowSystem(int nodes, int node_dim, int border_dim)
    : nodes_(nodes),
      n_(node_dim),
      m_(border_dim),
      node_rows_(Even(node_dim)),
      border_rows_(Even(border_dim)),
      height_(2 * node_rows_ + border_rows_) {
  if (nodes < 1 || node_dim < 1 || border_dim < 0) {
    throw std::logic_error("arrow system needs a node and an unknown");
  }
  const Eigen::Index unknowns = static_cast<Eigen::Index>(nodes) * n_ + m_;
  panels_.resize(PanelOffset(nodes));
  border_.resize(border_rows_ * m_);
  rhs_.resize(unknowns);
  scale_.resize(unknowns);
  inverse_diagonal_.resize(unknowns);
  SetZero();
}

void ArrowSystem::SetZero() {
  panels_.setZero();
  border_.setZero();
  rhs_.setZero();
  phase_ = Phase::kFilling;
}

void ArrowSystem::Require(Phase phase, const char* call) const {
  if (phase_ != phase) {
    throw std::logic_error(std::string("arrow system: ") + call +
                           (phase == Phase::kFactored ? " before" : " after") +
                           " Factor");
  }
}

ArrowSystem::Block ArrowSystem::node(int k) {
  return {Panel(k), n_, n_, Eigen::OuterStride<>(height_)};
}

ArrowSystem::Block ArrowSystem::coupling(int k) {
  return {Panel(k) + node_rows_, n_, n_, Eigen::OuterStride<>(height_)};
}

ArrowSystem::Block ArrowSystem::border_coupling(int k) {
  return {Panel(k) + 2 * node_rows_, m_, n_, Eigen::OuterStride<>(height_)};
}

ArrowSystem::Block ArrowSystem::border() {
  return {border_.data(), m_, m_, Eigen::OuterStride<>(border_rows_)};
}

void ArrowSystem::ScaleNode(int k) {
  const Block D = node(k);
  for (int j = 0; j < n_; ++j) scale_(k * n_ + j) = UnitScale(D(j, j));
}

void ArrowSystem::ScalePanel(int k) {
  Block D = node(k);
  Block B = border_coupling(k);
  const auto s = scale_.segment(k * n_, n_);
  const auto s_border = scale_.tail(m_);
  D.array().colwise() *= s.array();
  D.array().rowwise() *= s.transpose().array();
  B.array().colwise() *= s_border.array();
  B.array().rowwise() *= s.transpose().array();
  if (k + 1 == nodes_) return;
  Block E = coupling(k);
  E.array().colwise() *= scale_.segment((k + 1) * n_, n_).array();
  E.array().rowwise() *= s.transpose().array();
}

void ArrowSystem::ScaleBorder() {
  Block C = border();
  auto s = scale_.tail(m_);
  for (int j = 0; j < m_; ++j) s(j) = UnitScale(C(j, j));
  C.array().colwise() *= s.array();
  C.array().rowwise() *= s.transpose().array();
}

void ArrowSystem::EliminateNode(int k) {
  const double* W = Panel(k) + node_rows_;
  const double* V = W + node_rows_;
  for (int j = 0; k + 1 < nodes_ && j < n_; ++j) {
    double* next = Panel(k + 1) + static_cast<Eigen::Index>(j) * height_;
    const int first = j - j % kStrip;
    SubtractColumns(next + first, node_rows_ - first,
                    {W + first, height_, W + j, height_, n_});
    SubtractColumns(next + 2 * node_rows_, border_rows_,
                    {V, height_, W + j, height_, n_});
  }
  for (int j = 0; j < m_; ++j) {
    SubtractColumns(border_.data() + j * border_rows_, border_rows_,
                    {V, height_, V + j, height_, n_});
  }
}

std::vector<Deficiency> ArrowSystem::Factor(double tolerance) {
  Require(Phase::kFilling, "Factor");
  std::vector<Deficiency> deficient;
  ScaleBorder();
  ScaleNode(0);
  for (int k = 0; k < nodes_; ++k) {
    // The scale of a node comes from its diagonal before anything is
    // eliminated, and every block needs it before the panel above is.
    if (k == 0) {
      if (nodes_ > 1) ScaleNode(1);
      ScalePanel(0);
    }
    if (k + 1 < nodes_) {
      if (k + 2 < nodes_) ScaleNode(k + 2);
      ScalePanel(k + 1);
    }
    FactorPanel(Panel(k), height_, n_, tolerance, k,
                inverse_diagonal_.data() + k * n_, &deficient);
    EliminateNode(k);
  }
  if (m_ > 0) {
    FactorPanel(border_.data(), border_rows_, m_, tolerance,
                Deficiency::kBorder, inverse_diagonal_.data() + nodes_ * n_,
                &deficient);
  }
  phase_ = Phase::kFactored;
  return deficient;
}

void ArrowSystem::Solve() {
  Require(Phase::kFactored, "Solve");
  rhs_.array() *= scale_.array();
  // Rows of a panel: this node, the next, the border.
  Eigen::VectorXd work = Eigen::VectorXd::Zero(height_);
  auto here = work.head(n_);
  auto next = work.segment(node_rows_, n_);
  auto border = work.segment(2 * node_rows_, m_);
  border = rhs_border();
  for (int k = 0; k < nodes_; ++k) {
    here = rhs(k);
    work.segment(n_, node_rows_ - n_).setZero();
    next.setZero();
    if (k + 1 < nodes_) next = rhs(k + 1);
    SolveForward(Panel(k), height_, n_, inverse_diagonal_.data() + k * n_,
                 work.data());
    rhs(k) = here;
    if (k + 1 < nodes_) rhs(k + 1) = next;
  }
  if (m_ > 0) {
    const double* inverse = inverse_diagonal_.data() + nodes_ * n_;
    SolveForward(border_.data(), border_rows_, m_, inverse,
                 work.data() + 2 * node_rows_);
    SolveBackward(border_.data(), border_rows_, m_, inverse,
                  work.data() + 2 * node_rows_);
  }
  next.setZero();
  for (int k = nodes_ - 1; k >= 0; --k) {
    here = rhs(k);
    SolveBackward(Panel(k), height_, n_, inverse_diagonal_.data() + k * n_,
                  work.data());
    rhs(k) = here;
    next = here;
  }
  rhs_border() = border;
  rhs_.array() *= scale_.array();
}

Eigen::MatrixXd ArrowSystem::BorderCovariance() const {
  Require(Phase::kFactored, "BorderCovariance");
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(border_rows_, m_);
  if (m_ == 0) return Eigen::MatrixXd(0, 0);
  DivideByFactor(inverse.data(), border_rows_, m_, border_.data(), border_rows_,
                 inverse_diagonal_.data() + nodes_ * n_);
  const auto s = scale_.tail(m_).asDiagonal();
  return s * (inverse.transpose() * inverse) * s;
}

}  // namespace hindsight
