#ifndef HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_
#define HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_

#include <limits>

#include "dataset/rest.h"

namespace hindsight {

/// The decisions of FindRest, and where it leaves one open those of the
/// estimate. Over each window of an undecided span the forward filter, which
/// then knows nothing of that rest but all rests before it, predicts the
/// velocity: where it knows it to 0.3 m/s, one sigma of each axis, and zero
/// lies within the chi-square bound of 99.9 %, the vehicle stands and is
/// updated by that at once; where it knows it as well and zero lies outside, it
/// moves. What then is still open is asked of the smoothed estimate by the same
/// rule, until nothing new is decided, three times at most. Where the heading
/// at the start is not known to 20 deg the covariances are not trusted, and
/// what is open stays open, as where there is no estimate at all. Of all that
/// is decided so, what aiding contradicts over whole spans is left open
/// (LeaveOutContradicted).
Rest DecideRest(Dataset* dataset,
                double from = -std::numeric_limits<double>::infinity(),
                double to = std::numeric_limits<double>::infinity());

/// If Dataset::stationary asks for it: DecideRest over [from, to] and
/// AddRestStreams. The data set must not have the streams.
void AddDecidedRest(double from, double to, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_
