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

State PredictBackward(const ErrorLayout& layout, const State& x_j,
                      const ImuSummary& summary) {
  constexpr int kMaxIterations = 5;
  constexpr double kSettled = 1e-12;
  State x = x_j;
  x.t = summary.t_i;
  x.q_eb = x_j.q_eb * Correct(summary, CalibrationOf(layout, x_j)).dR.inverse();
  x.p_e -= summary.dt() * x_j.v_e;
  Transition transition;
  transition.c = ErrorVector::Zero(layout.dim());
  for (int i = 0; i < kMaxIterations; ++i) {
    const State there = Predict(layout, x, summary);
    LinearizeTransition(layout, summary, x, there, &transition);
    const ErrorVector d =
        transition.Phi.partialPivLu().solve(Local(layout, there, x_j));
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
  Transition transition;
  transition.c = ErrorVector::Zero(layout.dim());
  while (prior->x.t > from) {
    const ImuSummary summary =
        integrator.Summarize(std::max(from, prior->x.t - kStep), prior->x.t,
                             CalibrationOf(layout, prior->x));
    const State x = PredictBackward(layout, prior->x, summary);
    LinearizeTransition(layout, summary, x, prior->x, &transition);
    const auto lu = transition.Phi.partialPivLu();
    const ErrorMatrix half = lu.solve(ErrorMatrix(prior->P + transition.Q));
    ErrorMatrix P = lu.solve(ErrorMatrix(half.transpose()));
    Symmetrize(&P);
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
