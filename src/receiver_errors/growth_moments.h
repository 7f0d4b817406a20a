#ifndef HINDSIGHT_RECEIVER_ERRORS_GROWTH_MOMENTS_H_
#define HINDSIGHT_RECEIVER_ERRORS_GROWTH_MOMENTS_H_

namespace hindsight {

/// Of what has grown by a rate r ~ N(0, 1) for a time u [s]: E (r u)^2 and E r^2 u.
struct GrowthMoments {
  /// For T: T^2 and T.
  static GrowthMoments For(double T) { return {T * T, T}; }
  /// Since any time of the last T, one as likely as another: T^2 / 3 and T / 2.
  static GrowthMoments Within(double T) { return {T * T / 3.0, T / 2.0}; }

  double square = 0.0;
  double by_rate = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_GROWTH_MOMENTS_H_
