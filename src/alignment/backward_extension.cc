#include "alignment/backward_extension.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "filters/kalman.h"
#include "imu/imu_link.h"

namespace hindsight {
namespace {

constexpr double kStep = 1.0;  // [s]
constexpr double kLargestAttitude = 20.0 * kDegree;
constexpr double kLargestPosition = 1e4;  // [m]

double LargestSigma(const ErrorLayout& layout, BlockKind kind,
                    const ErrorMatrix& P) {
  const Block* block = layout.Find(kind);
  return std::sqrt(P.diagonal().segment(block->offset, block->dim).maxCoeff());
}

}  // namespace

namespace {

/// What a block that forgets is known to be at any time before anything was
/// measured: its stationary variance, or a larger a priori one. 0: the block
/// does not forget.
double StandingVariance(const Block& block) {
  const double stationary = block.evolution.StationaryVariance();
  if (stationary <= 0.0) return 0.0;
  return std::max(stationary, block.sigma0.cwiseAbs2().maxCoeff());
}

/// A layout in another order: first the components that do not forget (u, with
/// all of the motion), then those that do (s), with their standing variances.
struct Components {
  Eigen::PermutationMatrix<Eigen::Dynamic> order;
  Eigen::Index n_u = 0;
  Eigen::Index n_s = 0;
  Eigen::VectorXd variance;

  Eigen::MatrixXd Ordered(const ErrorMatrix& M) const {
    return order * Eigen::MatrixXd(M) * order.transpose();
  }
  Eigen::VectorXd Ordered(const ErrorVector& d) const {
    return order * Eigen::VectorXd(d);
  }
};

Components Split(const ErrorLayout& layout) {
  Components out;
  out.order.resize(layout.dim());
  out.variance.setZero(layout.dim());
  for (const Block& block : layout.blocks()) {
    (StandingVariance(block) > 0.0 ? out.n_s : out.n_u) += block.dim;
  }
  int u = 0;
  int s = 0;
  for (const Block& block : layout.blocks()) {
    const double variance = StandingVariance(block);
    for (int i = block.offset; i < block.offset + block.dim; ++i) {
      if (variance > 0.0) {
        out.variance(s) = variance;
        out.order.indices()(i) = static_cast<int>(out.n_u) + s++;
      } else {
        out.order.indices()(i) = u++;
      }
    }
  }
  out.variance.conservativeResize(out.n_s);
  return out;
}

/// The parts of a transition that leads back: s_i = B s_j + w',
/// u_i = A (u_j - K s_j - Phi_us s_i - w_u').
struct BackwardParts {
  Eigen::MatrixXd A, Phi_us, K, Q_uu, Q_us;
  Eigen::VectorXd B, Q_ss;
};

BackwardParts PartsOf(const Components& components,
                      const Transition& transition) {
  const Eigen::Index n_u = components.n_u;
  const Eigen::Index n_s = components.n_s;
  const Eigen::VectorXd& V = components.variance;
  const Eigen::MatrixXd Phi = components.Ordered(transition.Phi);
  const Eigen::MatrixXd Q = components.Ordered(transition.Q);
  const Eigen::VectorXd phi = Phi.diagonal().tail(n_s);
  const Eigen::VectorXd V_j =
      phi.cwiseAbs2().cwiseProduct(V) + Q.diagonal().tail(n_s);
  const Eigen::MatrixXd Q_us = Q.topRightCorner(n_u, n_s);
  BackwardParts out;
  out.A = Phi.topLeftCorner(n_u, n_u).partialPivLu().inverse();
  out.Phi_us = Phi.topRightCorner(n_u, n_s);
  out.B = phi.cwiseProduct(V).cwiseQuotient(V_j);
  out.Q_ss = V - out.B.cwiseAbs2().cwiseProduct(V_j);
  out.K = Q_us * V_j.cwiseInverse().asDiagonal();
  out.Q_uu = Q.topLeftCorner(n_u, n_u) - out.K * Q_us.transpose();
  out.Q_us = -Q_us * out.B.asDiagonal();
  return out;
}

ErrorMatrix CovarianceBefore(const Components& components,
                             const BackwardParts& parts, const ErrorMatrix& P) {
  const Eigen::Index n = P.rows();
  const Eigen::Index n_u = components.n_u;
  const Eigen::Index n_s = components.n_s;
  const Eigen::MatrixXd A_s = -parts.A * parts.Phi_us;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);  // of d_j
  F.topLeftCorner(n_u, n_u) = parts.A;
  F.topRightCorner(n_u, n_s) = A_s * parts.B.asDiagonal() - parts.A * parts.K;
  F.bottomRightCorner(n_s, n_s) = parts.B.asDiagonal();
  Eigen::MatrixXd G = Eigen::MatrixXd::Identity(n, n);  // of (w_u', w')
  G.topLeftCorner(n_u, n_u) = -parts.A;
  G.topRightCorner(n_u, n_s) = A_s;
  Eigen::MatrixXd N(n, n);
  N << parts.Q_uu, parts.Q_us, parts.Q_us.transpose(),
      Eigen::MatrixXd(parts.Q_ss.asDiagonal());
  const Eigen::MatrixXd before =
      F * components.Ordered(P) * F.transpose() + G * N * G.transpose();
  ErrorMatrix out = components.order.transpose() * before * components.order;
  Symmetrize(&out);
  return out;
}

/// The values that a state has, of what is additive.
ErrorVector ValuesOf(const ErrorLayout& layout, const State& x) {
  State zero = x;
  zero.b_g.setZero();
  zero.b_a.setZero();
  zero.parameters.setZero();
  return Local(layout, zero, x);
}

}  // namespace

State PredictBackward(const ErrorLayout& layout, const State& x_j,
                      const ImuSummary& summary) {
  constexpr int kMaxIterations = 5;
  constexpr double kSettled = 1e-12;
  const Components components = Split(layout);
  const Eigen::Index n_s = components.n_s;
  const auto forgetting = [&](const State& x) -> Eigen::VectorXd {
    return components.Ordered(ValuesOf(layout, x)).tail(n_s);
  };
  State x = x_j;
  x.t = summary.t_i;
  x.q_eb = x_j.q_eb * Correct(summary, CalibrationOf(layout, x_j)).dR.inverse();
  x.p_e -= summary.dt() * x_j.v_e;
  Transition transition;
  transition.c = ErrorVector::Zero(layout.dim());
  const Eigen::VectorXd s_j = forgetting(x_j);
  for (int i = 0; i < kMaxIterations; ++i) {
    const State there = Predict(layout, x, summary);
    LinearizeTransition(layout, summary, x, there, &transition);
    const BackwardParts parts = PartsOf(components, transition);
    const Eigen::VectorXd d_s = parts.B.cwiseProduct(s_j) - forgetting(x);
    const Eigen::VectorXd missing =
        components.Ordered(Local(layout, there, x_j)).head(components.n_u);
    Eigen::VectorXd d(layout.dim());
    d << parts.A * (missing - parts.K * s_j - parts.Phi_us * d_s), d_s;
    x = Retract(layout, x, components.order.transpose() * d);
    x.t = summary.t_i;
    if (d.norm() < kSettled * x.p_e.norm()) break;
  }
  return x;
}

void ExtendBackward(const ErrorLayout& layout, const ImuStream& imu,
                    double from, Prior* prior) {
  const bool with_scale =
      layout.Has(BlockKind::kGyroScale) || layout.Has(BlockKind::kAccelScale);
  ImuIntegrator integrator(imu, with_scale);
  const Components components = Split(layout);
  Transition transition;
  transition.c = ErrorVector::Zero(layout.dim());
  while (prior->x.t > from) {
    const ImuSummary summary =
        integrator.Summarize(std::max(from, prior->x.t - kStep), prior->x.t,
                             CalibrationOf(layout, prior->x));
    const State x = PredictBackward(layout, prior->x, summary);
    LinearizeTransition(layout, summary, x, prior->x, &transition);
    const ErrorMatrix P =
        CovarianceBefore(components, PartsOf(components, transition), prior->P);
    const bool grows = P.diagonal().sum() > prior->P.diagonal().sum();
    if (grows &&
        (LargestSigma(layout, BlockKind::kAttitude, P) > kLargestAttitude ||
         LargestSigma(layout, BlockKind::kPosition, P) > kLargestPosition)) {
      return;
    }
    *prior = {x, P};
  }
}

}  // namespace hindsight
