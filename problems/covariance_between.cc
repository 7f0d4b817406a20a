#include "problems/covariance_between.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "problems/sample_solution.h"
#include "problems/step_bridge.h"
#include "timeline/time_update.h"

namespace hindsight {
namespace {

bool HasScale(const ErrorLayout& layout) {
  return layout.Has(BlockKind::kGyroScale) ||
         layout.Has(BlockKind::kAccelScale);
}

constexpr int kMostMotion = 9;

/// The rows of position, velocity and attitude of a transition that keeps all
/// else. That of a Gauss-Markov block tends to zero over its correlation time
/// and has no useful inverse.
using MotionRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                 kMostMotion, kMaxErrorDim>;

/// b after a.
MotionRows Chain(const MotionRows& b, const MotionRows& a) {
  const Eigen::Index m = a.rows();
  MotionRows both = b.leftCols(m) * a;
  both.rightCols(a.cols() - m) += b.rightCols(a.cols() - m);
  return both;
}

MotionRows Inverse(const MotionRows& a) {
  const Eigen::Index m = a.rows();
  MotionRows inverse(m, a.cols());
  inverse.leftCols(m) = a.leftCols(m).inverse();
  inverse.rightCols(a.cols() - m) =
      -inverse.leftCols(m) * a.rightCols(a.cols() - m);
  return inverse;
}

/// P of an error that the transition has moved.
ErrorMatrix Moved(const MotionRows& Phi, const ErrorMatrix& P) {
  const Eigen::Index m = Phi.rows();
  const Eigen::Index rest = P.cols() - m;
  const MotionRows rows = Phi * P;
  ErrorMatrix out = P;
  out.topLeftCorner(m, m) = rows * Phi.transpose();
  out.topRightCorner(m, rest) = rows.rightCols(rest);
  out.bottomLeftCorner(rest, m) = rows.rightCols(rest).transpose();
  return out;
}

/// How the motion goes on over some time, and its noise.
struct MotionStep {
  using Noise = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                              kMostMotion, kMostMotion>;
  MotionRows Phi;
  Noise Q;

  static MotionStep None(Eigen::Index dim, Eigen::Index of) {
    return {MotionRows::Identity(dim, of), Noise::Zero(dim, dim)};
  }
  MotionStep Then(const Transition& step) const {
    const Eigen::Index m = Phi.rows();
    const MotionRows next = step.Phi.topRows(m);
    return {Chain(next, Phi),
            next.leftCols(m) * Q * next.leftCols(m).transpose() +
                step.Q.topLeftCorner(m, m)};
  }
};

/// Of position, velocity and attitude, which stand first in a layout.
int MotionDim(const ErrorLayout& layout) {
  int dim = 0;
  for (const Block& block : layout.blocks()) {
    if (block.key.kind <= BlockKind::kAttitude) dim += block.dim;
  }
  return dim;
}

}  // namespace

CovarianceBetween::CovarianceBetween(const Solution& solution,
                                     const Timeline& timeline,
                                     const ImuStream& imu,
                                     const CovarianceOptions& covariance)
    : solution_(solution),
      timeline_(timeline),
      integrator_(imu, HasScale(solution.layout)),
      policy_(covariance, solution.layout) {}

ErrorMatrix CovarianceBetween::At(std::size_t k, double t) {
  if (k != node_) StepFrom(k);
  std::size_t i = 1;
  while (i + 1 < t_.size() && t_[i] < t) ++i;
  const double a = (t - t_[i - 1]) / (t_[i] - t_[i - 1]);
  ErrorMatrix P = (1.0 - a) * P_[i - 1] + a * P_[i];
  if (!solution_.forward) AddSteps(k, t, &P);
  return P;
}

void CovarianceBetween::AddSteps(std::size_t k, double t,
                                 ErrorMatrix* P) const {
  const auto bridge = BridgeOverSteps(solution_.layout, timeline_, k, t);
  if (!bridge) return;
  const Eigen::Matrix2d& C = bridge->covariance;
  for (int axis = 0; axis < 3; ++axis) {
    const int p = bridge->position + axis;
    const int v = bridge->velocity + axis;
    (*P)(p, p) += C(0, 0);
    (*P)(p, v) += C(0, 1);
    (*P)(v, p) += C(1, 0);
    (*P)(v, v) += C(1, 1);
  }
}

void CovarianceBetween::StepFrom(std::size_t k) {
  node_ = k;
  const double begin = solution_.states[k].t;
  const double T = solution_.states[k + 1].t - begin;
  const int steps =
      std::max(1, static_cast<int>(std::ceil(T / kPropagationStep)));
  t_ = {begin};
  for (int i = 1; i < steps; ++i) t_.push_back(begin + T * i / steps);
  t_.push_back(solution_.states[k + 1].t);
  P_.assign(1, solution_.covariances.Get(k));
  if (solution_.forward) {
    Predict(k);
  } else if (steps == 1) {
    P_.push_back(solution_.covariances.Get(k + 1));
  } else {
    Bridge(k);
  }
}

template <typename Step>
void CovarianceBetween::ForEachStep(std::size_t k, const Step& step) {
  State end = solution_.states[k];
  for (std::size_t i = 1; i < t_.size(); ++i) {
    const State begin = end;
    const ImuSummary summary = integrator_.Summarize(
        begin.t, t_[i], CalibrationOf(solution_.layout, begin));
    const NodeInterval interval = {timeline_, k, summary, solution_.forward};
    end = Advance(solution_.layout, interval, begin);
    LinearizeAdvance(solution_.layout, interval, begin, end, &transition_);
    step(transition_, summary.dt());
  }
}

void CovarianceBetween::Predict(std::size_t k) {
  ErrorMatrix P = P_.front();
  ForEachStep(k, [&](const Transition& transition, double dt) {
    policy_.Predict(transition, dt, &P);
    P_.push_back(P);
  });
}

void CovarianceBetween::Bridge(std::size_t k) {
  const ErrorMatrix before = P_.front();
  const ErrorMatrix after = solution_.covariances.Get(k + 1);
  std::vector<MotionStep> from_node = {
      MotionStep::None(MotionDim(solution_.layout), before.rows())};
  ForEachStep(k, [&](const Transition& transition, double) {
    from_node.push_back(from_node.back().Then(transition));
  });
  const MotionRows back = Inverse(from_node.back().Phi);
  for (std::size_t i = 1; i + 1 < t_.size(); ++i) {
    const double a = (t_[i] - t_.front()) / (t_.back() - t_.front());
    const auto& [Phi, Q] = from_node[i];
    ErrorMatrix P = (1.0 - a) * Moved(Phi, before);
    P.topLeftCorner(Q.rows(), Q.cols()) += (1.0 - a) * Q;
    P_.emplace_back(P + a * Moved(Chain(Phi, back), after));
  }
  P_.push_back(after);
}

}  // namespace hindsight
