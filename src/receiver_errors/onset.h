#ifndef HINDSIGHT_RECEIVER_ERRORS_ONSET_H_
#define HINDSIGHT_RECEIVER_ERRORS_ONSET_H_

namespace hindsight {

/// In which part of the time that nothing was seen something began: as usual (UnseenTime),
/// or in one of its quarters.
enum class Onset : char { kUsual, kFirst, kSecond, kThird, kFourth };

/// ln of what it is worth a priori: that of a quarter.
double LogPriorOf(Onset onset);

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

/// The time since what begins would last have been seen.
struct UnseenTime {
  double length = 0.0;     ///< [s]
  bool lacks_fix = false;  ///< one or more are missing in it

  /// Of what began in it so. Usual is at its begin, or, where it lacks a fix, at any time of
  /// it. Of a product of rate and time these are the first two moments alone: they let it
  /// jump by an error of which the rate stays, least where the time is known best.
  GrowthMoments Grown(Onset onset) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ONSET_H_
