#ifndef HINDSIGHT_TIMELINE_VELOCITY_STEP_H_
#define HINDSIGHT_TIMELINE_VELOCITY_STEP_H_

namespace hindsight {

/// Of what has grown by a rate r ~ N(0, 1) for a time u [s]: E (r u)^2 and E r^2 u.
struct GrowthMoments {
  /// u uniform between two times:
  ///   (least^2 + least most + most^2) / 3 and (least + most) / 2.
  static GrowthMoments Between(double least, double most) {
    return {(least * least + least * most + most * most) / 3.0,
            (least + most) / 2.0};
  }

  double square = 0.0;
  double by_rate = 0.0;
};

/// A step of the velocity that the IMU does not tell (lost samples, a shock beyond its
/// range): N(0, variance) an axis, once, at a time that is uniform between two.
struct VelocityStep {
  /// Noise of position and velocity, an axis: of w_p^2, w_p w_v and w_v^2.
  struct Noise {
    double pp = 0.0;  ///< [m^2]
    double pv = 0.0;  ///< [m^2/s]
    double vv = 0.0;  ///< [m^2/s^2]
  };

  double variance = 0.0;  ///< [m^2/s^2]
  double begin = 0.0;     ///< [s]
  double end = 0.0;       ///< [s]

  /// What of it happens in from <= t < to, as it is at `to`: so parts one after the other
  /// make up the whole.
  Noise Within(double from, double to) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_TIMELINE_VELOCITY_STEP_H_
