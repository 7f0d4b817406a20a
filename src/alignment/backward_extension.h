#ifndef HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_
#define HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_

#include "filters/forward_filter.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// The most likely state at the begin of `summary` if it is x_j at its end: for
/// what does not forget the x_i with Predict(x_i) = x_j, by Newton's method on
/// the same equations; for the rest see ExtendBackward.
State PredictBackward(const ErrorLayout& layout, const State& x_j,
                      const ImuSummary& summary);

/// Carries a prior back to time `from` against the IMU, in steps of 1 s. With
///   u_j = Phi_uu u_i + Phi_us s_i + w_u,   s_j = phi s_i + w_s,
/// s are the blocks that forget (Gauss-Markov, over time or distance) and u all
/// others. Nothing is known of u beforehand, but s was, before as after, of
/// variance V: stationary, or a priori if that is larger. Then
///   s_i = B s_j + w',   B = phi V / V_j,   V_j = phi^2 V + Q_ss,
///   u_i = Phi_uu^-1 (u_j - Phi_us s_i - K s_j - w_u'),   K = Q_us / V_j,
///   cov(w') = V - B V_j B,   cov(w_u') = Q_uu - K Q_su,
///   cov(w_u', w') = -Q_us B;
/// of a stationary block B = phi and cov(w') = Q_ss: it is the same with time
/// reversed. Without such blocks P_i = Phi^-1 (P_j + Q) Phi^-T.
/// The distance of an odometer's increment has no meaning before its first
/// count, with which it begins: value and variance stay as they are.
/// A filter that starts there arrives at the old epoch with what was known
/// there, and what aiding there is in between counts. Stops early where
/// attitude is less sure than 20 deg or position than 10 km, since nothing is
/// linear then.
void ExtendBackward(const ErrorLayout& layout, const ImuStream& imu,
                    double from, Prior* prior);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_BACKWARD_EXTENSION_H_
