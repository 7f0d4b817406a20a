#include "filters/rts.h"

#include <Eigen/Cholesky>

#include "base/error.h"
#include "filters/transport.h"

namespace hindsight {
namespace {

/// Writes epoch k from the smoothed error about x_plus, and carries that error
/// and covariance into the tangent at x_minus, where the interval before ends.
void WriteEpoch(const LinearTape& tape, std::size_t k, ErrorVector* d,
                ErrorMatrix* P, SmoothedTrajectory* out) {
  const TapeEpoch& epoch = tape.epoch(k);
  out->states[k] = tape.StateAt(k, *d);
  out->P.Set(k, *P);
  if (epoch.moves_nominal()) {
    MoveBack(tape.ResetTransport(k), d, P);
    *d += epoch.dx_plus;
  }
  out->d[k] = *d;
}

SmoothedTrajectory Smooth(const LinearTape& tape, LinearTape* consumed) {
  RequireSmoothable(tape);
  const std::size_t count = tape.size();
  SmoothedTrajectory out;
  out.states.resize(count);
  out.d.resize(count);
  out.P = CovarianceSeries(tape.dim(), count);
  if (count == 0) return out;

  ErrorVector d = ErrorVector::Zero(tape.dim());
  if (!tape.back().reset) d = tape.back().dx_plus;
  ErrorMatrix P = tape.P_plus(count - 1);
  WriteEpoch(tape, count - 1, &d, &P, &out);
  for (std::size_t k = count - 1; k-- > 0;) {
    const ErrorMatrix Phi = tape.Phi(k + 1);
    const ErrorMatrix P_plus = tape.P_plus(k);
    const Eigen::LLT<ErrorMatrix> llt(tape.P_minus(k + 1));
    if (llt.info() != Eigen::Success) {
      throw EstimationError(
          "predicted covariance is not positive definite at t = " +
          std::to_string(tape.epoch(k + 1).t) + " s");
    }
    const ErrorMatrix PhiP = Phi * P_plus;
    const ErrorMatrix C = llt.solve(PhiP).transpose();
    ErrorMatrix A = ErrorMatrix::Identity(tape.dim(), tape.dim());
    A.noalias() -= C * Phi;
    d = (C * (d - tape.epoch(k + 1).dx_minus)).eval();
    if (!tape.epoch(k).reset) d += tape.epoch(k).dx_plus;
    P += tape.Q(k + 1);
    const ErrorMatrix CP = C * P;
    P.noalias() = CP * C.transpose();
    const ErrorMatrix AP = A * P_plus;
    P.noalias() += AP * A.transpose();
    Symmetrize(&P);
    if (consumed != nullptr) consumed->PopBack();
    WriteEpoch(tape, k, &d, &P, &out);
  }
  return out;
}

}  // namespace

SmoothedTrajectory SmoothRts(const LinearTape& tape) {
  return Smooth(tape, nullptr);
}

SmoothedTrajectory SmoothRts(LinearTape&& tape) { return Smooth(tape, &tape); }

}  // namespace hindsight
