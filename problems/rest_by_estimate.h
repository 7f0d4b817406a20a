#ifndef HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_
#define HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_

#include <limits>

#include "dataset/rest.h"

namespace hindsight {

/// The decisions of FindRest, and for the spans that it leaves undecided those
/// of an estimate. In each window of such a span the forward filter predicts
/// the velocity, with all rests before the window but without this one. If it
/// predicts it to 0.3 m/s (one sigma of each axis) and zero lies within the
/// chi-square bound of 99.9 %, the vehicle stands, and the filter is updated
/// with that at once; if zero lies outside, it moves. Windows that are still
/// open are judged by the smoothed estimate with the same rule. All of this is
/// repeated until nothing new is decided, three times at most. If the heading
/// at the start is not known to 20 deg, the covariances are not trusted, and
/// what is open stays open; likewise if the data cannot be solved. At last,
/// decisions that aiding contradicts over a whole span are left open again
/// (LeaveOutContradicted).
Rest DecideRest(Dataset* dataset,
                double from = -std::numeric_limits<double>::infinity(),
                double to = std::numeric_limits<double>::infinity());

/// If Dataset::stationary asks for it: DecideRest over [from, to] and
/// AddRestStreams. The data set must not have the streams.
void AddDecidedRest(double from, double to, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_REST_BY_ESTIMATE_H_
