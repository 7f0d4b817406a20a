#include "filters/covariance_policy.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "filters/kalman.h"

namespace hindsight {
namespace {

std::string EscapeMessage(double t, double weight) {
  return fmt::format(
      "the Riccati equation escapes to infinity at t = {:.3f} s "
      "(weight of L'L {:.4g} 1/s)",
      t, weight);
}

double LargestEigenvalue(const Eigen::MatrixXd& M) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Time after which I - weight t L P L' is singular; zero if L P L' is not
/// finite.
double TimeToEscape(double weight, const Eigen::MatrixXd& LPL) {
  if (!LPL.allFinite()) return 0.0;
  return 1.0 / (weight * LargestEigenvalue(LPL));
}

bool IsPositiveDefinite(const Eigen::MatrixXd& M) {
  // Eigen's factorisation reports success for a matrix of NaN.
  return M.allFinite() && M.llt().info() == Eigen::Success;
}

}  // namespace

FiniteEscape::FiniteEscape(double t, double weight)
    : EstimationError(EscapeMessage(t, weight)), t_(t) {}

CovariancePolicy::CovariancePolicy(const CovarianceOptions& options,
                                   const ErrorLayout& layout)
    : may_back_off_(options.back_off), L_(LMatrix::Zero(0, layout.dim())) {
  if (options.rule == RiccatiRule::kHInfinity) {
    weight_ = 1.0 / (options.gamma * options.gamma);
  } else if (options.rule == RiccatiRule::kModifiedHInfinity) {
    weight_ = options.delta;
    if (options.alpha != 0.0) alpha_ = ErrorVector::Zero(layout.dim());
  }
  for (const Block& block : layout.blocks()) {
    const bool chosen = options.alpha_on_all ||
                        block.key.kind == BlockKind::kVelocity ||
                        block.key.kind == BlockKind::kAttitude;
    if (alpha_.size() == 0 || !chosen) continue;
    alpha_.segment(block.offset, block.dim).setConstant(options.alpha);
  }
  for (const CovarianceOptions::Bounded& bounded : options.L) {
    const Block* block = layout.Find(bounded.kind);
    if (block == nullptr) {
      throw std::logic_error("L names a block that is not estimated");
    }
    const Eigen::Index row = L_.rows();
    L_.conservativeResize(row + block->dim, Eigen::NoChange);
    L_.bottomRows(block->dim).setZero();
    L_.block(row, block->offset, block->dim, block->dim)
        .diagonal()
        .setConstant(1.0 / bounded.unit);
  }
}

void CovariancePolicy::Predict(const Transition& transition, double dt,
                               ErrorMatrix* P) const {
  if (alpha_.size() == 0) {
    PredictCovariance(transition.Phi, transition.Q, P);
    return;
  }
  const ErrorVector growth = (dt * alpha_).array().exp();
  const ErrorMatrix Phi = growth.asDiagonal() * transition.Phi;
  PredictCovariance(Phi, transition.Q, P);
}

void CovariancePolicy::Bound(double t, double dt, ErrorVector* dx,
                             ErrorMatrix* P) {
  if (is_kalman()) return;
  if (!IsPositiveDefinite(*P)) throw FiniteEscape(t, weight_);
  if (weight_ == 0.0 || dt <= 0.0) return;
  const LMatrix LP = L_ * *P;
  const LMatrix LPL = LP * L_.transpose();
  const LMatrix I = LMatrix::Identity(L_.rows(), L_.rows());
  const LMatrix M = I - weight_ * dt * LPL;
  if (may_back_off_ && !IsPositiveDefinite(M - 0.5 * I)) {
    ++record_.back_offs;
    return;
  }
  if (!IsPositiveDefinite(M)) {
    throw FiniteEscape(t - dt + TimeToEscape(weight_, LPL), weight_);
  }
  record_.least_information = std::min(
      record_.least_information, 1.0 - weight_ * dt * LargestEigenvalue(LPL));
  const LMatrix gain = weight_ * dt * M.llt().solve(LP);  // theta (...)^-1 L P
  const ErrorMatrix added = LP.transpose() * gain;
  // P P_before^-1 dx = dx + P L' theta (...)^-1 L dx.
  *dx += (gain.transpose() * (L_ * *dx)).eval();
  *P += added;
  Symmetrize(P);
}

ErrorMatrix CovariancePolicy::WeightMatrix() const {
  return weight_ * L_.transpose() * L_;
}

}  // namespace hindsight
