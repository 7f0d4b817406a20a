#ifndef HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_
#define HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_

#include "filters/forward_filter.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// The state from which the IMU leads to x_j at the end of `summary`: the x_i
/// with Predict(x_i) = x_j, by Newton's method on the same equations.
State PredictBackward(const ErrorLayout& layout, const State& x_j,
                      const ImuSummary& summary);

/// Carries a prior back to time `from` against the IMU, in steps of 1 s:
///   x_i = PredictBackward(x_j),   P_i = Phi^-1 (P_j + Q) Phi^-T.
/// A filter that starts there arrives at the old epoch with what was known
/// there, and what aiding there is in between counts. Stops early where
/// attitude is less sure than 20 deg or position than 10 km, since nothing is
/// linear then.
void ExtendBackward(const ErrorLayout& layout, const ImuStream& imu,
                    double from, Prior* prior);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_
