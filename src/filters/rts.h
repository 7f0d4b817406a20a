#ifndef HINDSIGHT_FILTERS_RTS_H_
#define HINDSIGHT_FILTERS_RTS_H_

#include <vector>

#include "filters/linear_tape.h"
#include "state/covariance_series.h"

namespace hindsight {

/// A smoothed tape, an entry an epoch.
struct SmoothedTrajectory {
  std::vector<State> states;
  /// Smoothed error about x_minus; where the nominal was reset, to first order,
  /// d = dx_plus + T^-1 d_plus.
  std::vector<ErrorVector> d;
  CovarianceSeries P;  ///< in the tangent at x_plus, unless asked otherwise
};

struct RtsOptions {
  enum class Tangent { kNominal, kSmoothed };
  bool errors =
      true;  ///< else SmoothedTrajectory::d stays empty: a day's take 34 MB
  Tangent covariances =
      Tangent::kNominal;  ///< at x_plus, or at the smoothed states
};

/// Rauch-Tung-Striebel smoother (1965) on a tape:
///   C = P+ Phi' (P-)^-1 of the next epoch,   A = I - C Phi,
///   d+ = m + C (d-_next - dx-_next),   P_s = A P+ A' + C (P_s,next + Q) C',
/// m the mean about x_plus. The covariance is the sum of two products that are
/// positive semidefinite, not a difference: a diffuse prior costs no digits.
SmoothedTrajectory SmoothRts(const LinearTape& tape,
                             const RtsOptions& options = {});

/// The same, releasing the tape's memory on the way back.
SmoothedTrajectory SmoothRts(LinearTape&& tape, const RtsOptions& options = {});

/// The same without covariances, P empty, at a fraction of the cost.
SmoothedTrajectory SmoothMeans(const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_RTS_H_
