#include "filters/two_filter.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "base/error.h"
#include "filters/information.h"
#include "filters/separation.h"

namespace hindsight {
namespace {

TwoFilterResult Allocate(const LinearTape& tape) {
  RequireSmoothable(tape);
  TwoFilterResult out;
  out.trajectory.states.resize(tape.size());
  out.trajectory.d.resize(tape.size());
  out.trajectory.P = CovarianceSeries(tape.dim(), tape.size());
  if (tape.layout().Has(BlockKind::kPosition)) {
    out.part.separation.resize(tape.size());
  }
  out.part.components.resize(tape.size());
  return out;
}

/// Standard deviations of the last epoch, where most is known, as the units of
/// the backward information: its elements are then of order one.
ErrorVector ScaleOf(const ErrorMatrix& P) {
  if (!(P.diagonal().minCoeff() > 0.0)) {
    throw EstimationError("forward covariance is not positive definite");
  }
  return P.diagonal().cwiseSqrt();
}

/// How far the backward filter alone is from the forward filter at epoch k.
void RecordSeparation(const LinearTape& tape, std::size_t k,
                      const Information::Estimate& alone,
                      const ErrorVector& scale, TwoFilterResult* out) {
  const BackwardSide side(tape, k, alone, scale);
  if (!out->part.separation.empty()) out->part.separation[k] = side.Distance();
  out->part.components[k] = side.Components();
  constexpr std::size_t kMost = TwoFilterResult::kMostBackward;
  const std::size_t step = (tape.size() + kMost - 1) / kMost;
  if (k % step == 0) out->part.backward.push_back(side.Alone());
}

}  // namespace

TwoFilterResult SmoothTwoFilter(const LinearTape& tape) {
  TwoFilterResult out = Allocate(tape);
  if (tape.size() == 0) return out;
  const ErrorVector zero = ErrorVector::Zero(tape.dim());
  const ErrorVector scale = ScaleOf(tape.P_plus(tape.size() - 1));
  Information information(scale);
  for (std::size_t k = tape.size(); k-- > 0;) {
    const TapeEpoch& epoch = tape.epoch(k);
    const ErrorVector& forward = epoch.reset ? zero : epoch.dx_plus;
    RecordSeparation(tape, k, information.AloneAbout(forward), scale, &out);
    const Information::Estimate smoothed =
        information.Fuse(forward, tape.P_plus(k));
    SmoothedTrajectory& trajectory = out.trajectory;
    trajectory.states[k] = tape.StateAt(epoch, smoothed.mean);
    trajectory.P.Set(k, smoothed.P);
    trajectory.d[k] = smoothed.mean;
    if (epoch.moves_nominal()) {
      const ErrorMatrix T = tape.ResetTransport(epoch);
      trajectory.d[k] = epoch.dx_plus + T.partialPivLu().solve(smoothed.mean);
      information.Substitute(T, epoch.dx_plus);
    }
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (z.accepted) information.Add(z.H, z.R, z.residual);
    }
    if (k > 0) information.PropagateBack(tape.Phi(k), tape.Q(k), epoch.c);
  }
  std::reverse(out.part.backward.begin(), out.part.backward.end());
  return out;
}

namespace {

/// The forward solution of one epoch in the coordinates of its chart.
struct ChartedEpoch {
  ChartedEpoch(const LinearTape& tape, std::size_t k, ChartKind kind)
      : chart(tape.layout(), kind, tape.epoch(k).x_minus,
              tape.epoch(0).x_minus.p_e),
        xi_minus(chart.Coordinates(tape.epoch(k).x_minus)),
        xi_plus(chart.Coordinates(tape.epoch(k).x_plus)),
        J_minus(chart.Jacobian(tape.epoch(k).x_minus)),
        J_plus(chart.Jacobian(tape.epoch(k).x_plus)),
        J_plus_inverse(J_plus.partialPivLu().inverse()) {
    const TapeEpoch& epoch = tape.epoch(k);
    xi_forward = xi_plus;
    if (!epoch.reset) xi_forward += J_plus * epoch.dx_plus;
    P_forward = J_plus * tape.P_plus(k) * J_plus.transpose();
    Symmetrize(&P_forward);
  }

  Chart chart;
  ErrorVector xi_minus, xi_plus;  ///< of the nominal
  ErrorMatrix J_minus, J_plus, J_plus_inverse;
  ErrorVector xi_forward;  ///< forward estimate after the update
  ErrorMatrix P_forward;
};

/// Measurements of epoch k as observations of the coordinates, eq. (20).
void AddMeasurements(const LinearTape& tape, std::size_t k,
                     const ChartedEpoch& charted, Information* information) {
  if (tape.measurements(k).empty()) return;
  const Eigen::PartialPivLU<ErrorMatrix> lu(charted.J_minus.transpose());
  for (const TapeMeasurement& z : tape.measurements(k)) {
    if (!z.accepted) continue;
    const ErrorMatrix Ht = z.H.transpose();
    const RowJacobian H = lu.solve(Ht).transpose();
    information->Add(H, z.R, z.residual + H * charted.xi_minus);
  }
}

}  // namespace

TwoFilterResult SmoothTwoFilterConventional(const LinearTape& tape,
                                            ChartKind chart) {
  TwoFilterResult out = Allocate(tape);
  if (tape.size() == 0) return out;
  const ErrorLayout& layout = tape.layout();
  const ErrorVector scale = ScaleOf(tape.P_plus(tape.size() - 1));
  ChartedEpoch here(tape, tape.size() - 1, chart);
  Information information(ScaleOf(here.P_forward));
  for (std::size_t k = tape.size(); k-- > 0;) {
    const TapeEpoch& epoch = tape.epoch(k);
    Information::Estimate alone = information.AloneAbout(here.xi_forward);
    alone.mean = here.J_plus_inverse * alone.mean;
    alone.P = here.J_plus_inverse * alone.P * here.J_plus_inverse.transpose();
    RecordSeparation(tape, k, alone, scale, &out);
    const Information::Estimate smoothed =
        information.Fuse(here.xi_forward, here.P_forward);
    SmoothedTrajectory& trajectory = out.trajectory;
    trajectory.states[k] = here.chart.ToState(smoothed.mean);
    trajectory.states[k].t = epoch.t;
    trajectory.d[k] = Local(layout, epoch.x_minus, trajectory.states[k]);
    ErrorMatrix P =
        here.J_plus_inverse * smoothed.P * here.J_plus_inverse.transpose();
    Symmetrize(&P);
    trajectory.P.Set(k, P);
    AddMeasurements(tape, k, here, &information);
    if (k == 0) break;
    ChartedEpoch before(tape, k - 1, chart);
    const ErrorMatrix F = here.J_minus * tape.Phi(k) * before.J_plus_inverse;
    const ErrorMatrix Q = here.J_minus * tape.Q(k) * here.J_minus.transpose();
    const ErrorVector a =
        here.xi_minus + here.J_minus * epoch.c - F * before.xi_plus;
    information.PropagateBack(F, Q, a);
    here = std::move(before);
  }
  std::reverse(out.part.backward.begin(), out.part.backward.end());
  return out;
}

}  // namespace hindsight
