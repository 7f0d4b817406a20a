#ifndef HINDSIGHT_FILTERS_TWO_FILTER_H_
#define HINDSIGHT_FILTERS_TWO_FILTER_H_

#include <vector>

#include "filters/rts.h"
#include "state/chart.h"
#include "state/method_parts.h"

namespace hindsight {

/// A tape smoothed by fusing a forward with a backward filter.
struct TwoFilterResult {
  SmoothedTrajectory trajectory;
  /// `backward` at no more than kMostBackward epochs.
  TwoFilterPart part;
  static constexpr std::size_t kMostBackward = 5000;
};

/// Two-filter smoother in error form (Yu, Lee, Park, Han 2002, section III).
///
/// Signs: the paper's errors are estimate - truth, those of the tape truth -
/// estimate, so the paper's dy_b is -y here; its eqs. (44), (45) define the
/// residual as estimate - measured, against (29), where dz = z - h(x_f(-)) as
/// everywhere in this program. With H at x_f(-), dx_f = x_f(-) - x_f(+) and
/// these signs (29) is exact:
///   after the interval,  (26)  Information::PropagateBack, as (18), d/d tau;
///   fusion at t_k,       (30)  P_s^-1 = P_f(+)^-1 + P_b^-1,
///                              x_s = x_f(+) [+] P_s y_b;
///   nominal x_f(+) to x_f(-):  y <- T' (y + P_b^-1 T dx), the term
///                              P_b^-1 dx_f of (29), T the tape's transport;
///   measurement at t_k,  (29), (21)  y += H' R^-1 dz, P_b^-1 += H' R^-1 H.
/// y_b and P_b in (30) are those before the measurement at t_k, which is in
/// x_f(+), P_f(+) already; as printed, with (+), it would count twice. About a
/// fixed nominal the third step falls away and the forward mean enters (30).
///
/// Equals SmoothRts on every tape but for rounding. Throws EstimationError if
/// a forward covariance is not positive definite.
TwoFilterResult SmoothTwoFilter(const LinearTape& tape);

/// Two-filter smoother in the full state (section II of the paper, after
/// Leondes, Peller and Stear 1970): x_b itself, in the coordinates of a chart
/// whose reference is x_f(-) at each epoch.
///   (15), (19)  x+ = x_f+(-) + F (x - x_f(+)) + w,  F = J Phi J^-1;
///   (20)        y += H' R^-1 (z - h(x_n) + H x_n): the printed +H x_b must
///               read +H x_n, x_n = x_f(-), or y would not stay linear;
///   (22), (23)  P_s^-1 = P_f(+)^-1 + P_b^-1,  x_s = P_s (P_f(+)^-1 x_f(+) +
///               y_b), with y_b before the measurement at t_k.
/// In the additive chart this is the error form. In the Euler chart coordinates
/// are not linear over the steps from x_f(-) to x_f(+) and to x_s, and the two
/// agree to first order in these steps only.
TwoFilterResult SmoothTwoFilterConventional(const LinearTape& tape,
                                            ChartKind chart);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_TWO_FILTER_H_
