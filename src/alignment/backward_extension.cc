#include "alignment/backward_extension.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

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
  const Evolution& evolution = block.evolution;
  double stationary = 0.0;
  if (evolution.kind == Evolution::Kind::kGaussMarkov) {
    stationary = 0.5 * evolution.density * evolution.density * evolution.tau;
  } else if (evolution.kind == Evolution::Kind::kSpatialGaussMarkov) {
    stationary = evolution.density * evolution.density;
  } else {
    return 0.0;
  }
  return std::max(stationary, block.sigma0.cwiseAbs2().maxCoeff());
}

/// The components of a layout that do not forget (u, with all of the motion)
/// and those that do (s), with the standing variance of the latter.
struct Components {
  std::vector<int> u, s;
  Eigen::VectorXd variance;
};

Components Split(const ErrorLayout& layout) {
  Components out;
  std::vector<double> variances;
  for (const Block& block : layout.blocks()) {
    const double variance = StandingVariance(block);
    for (int i = block.offset; i < block.offset + block.dim; ++i) {
      if (variance > 0.0) variances.push_back(variance);
      (variance > 0.0 ? out.s : out.u).push_back(i);
    }
  }
  out.variance = Eigen::Map<const Eigen::VectorXd>(
      variances.data(), static_cast<Eigen::Index>(variances.size()));
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
  const auto& [u, s, V] = components;
  BackwardParts out;
  out.A = Eigen::MatrixXd(transition.Phi(u, u)).inverse();
  out.Phi_us = transition.Phi(u, s);
  const Eigen::VectorXd phi = Eigen::MatrixXd(transition.Phi(s, s)).diagonal();
  const Eigen::VectorXd q = Eigen::MatrixXd(transition.Q(s, s)).diagonal();
  const Eigen::VectorXd V_j = phi.cwiseAbs2().cwiseProduct(V) + q;
  const Eigen::MatrixXd Q_us = transition.Q(u, s);
  out.B = phi.cwiseProduct(V).cwiseQuotient(V_j);
  out.Q_ss = V - out.B.cwiseAbs2().cwiseProduct(V_j);
  out.K = Q_us * V_j.cwiseInverse().asDiagonal();
  out.Q_uu = Eigen::MatrixXd(transition.Q(u, u)) - out.K * Q_us.transpose();
  out.Q_us = -Q_us * out.B.asDiagonal();
  return out;
}

ErrorMatrix CovarianceBefore(const Components& components,
                             const BackwardParts& parts, const ErrorMatrix& P) {
  const auto& [u, s, V] = components;
  const Eigen::Index n = P.rows();
  const auto n_s = static_cast<Eigen::Index>(s.size());
  const Eigen::MatrixXd B = parts.B.asDiagonal();
  const Eigen::MatrixXd A_s = -parts.A * parts.Phi_us;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);  // of d_j
  F(u, u) = parts.A;
  F(u, s) = A_s * B - parts.A * parts.K;
  F(s, s) = B;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n);  // of (w_u', w')
  G(u, u) = -parts.A;
  G(u, s) = A_s;
  G(s, s) = Eigen::MatrixXd::Identity(n_s, n_s);
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(n, n);
  N(u, u) = parts.Q_uu;
  N(u, s) = parts.Q_us;
  N(s, u) = parts.Q_us.transpose();
  N(s, s) = Eigen::MatrixXd(parts.Q_ss.asDiagonal());
  ErrorMatrix out =
      F * Eigen::MatrixXd(P) * F.transpose() + G * N * G.transpose();
  Symmetrize(&out);
  return out;
}

/// The values of the components that forget, in the order of Components::s.
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
  const auto& [u, s, V] = components;
  State x = x_j;
  x.t = summary.t_i;
  x.q_eb = x_j.q_eb * Correct(summary, CalibrationOf(layout, x_j)).dR.inverse();
  x.p_e -= summary.dt() * x_j.v_e;
  Transition transition;
  transition.c = ErrorVector::Zero(layout.dim());
  const Eigen::VectorXd s_j = ValuesOf(layout, x_j)(s);
  for (int i = 0; i < kMaxIterations; ++i) {
    const State there = Predict(layout, x, summary);
    LinearizeTransition(layout, summary, x, there, &transition);
    const BackwardParts parts = PartsOf(components, transition);
    const Eigen::VectorXd missing = Local(layout, there, x_j)(u);
    ErrorVector d = ErrorVector::Zero(layout.dim());
    const Eigen::VectorXd d_s =
        parts.B.cwiseProduct(s_j) - Eigen::VectorXd(ValuesOf(layout, x)(s));
    d(s) = d_s;
    d(u) = parts.A * (missing - parts.K * s_j - parts.Phi_us * d_s);
    x = Retract(layout, x, d);
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
