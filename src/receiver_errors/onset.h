#ifndef HINDSIGHT_RECEIVER_ERRORS_ONSET_H_
#define HINDSIGHT_RECEIVER_ERRORS_ONSET_H_

#include "timeline/velocity_step.h"

namespace hindsight {

/// In which part of the time that nothing was seen something began: as usual (UnseenTime),
/// or in one of its quarters.
enum class Onset : char { kUsual, kFirst, kSecond, kThird, kFourth };

/// ln of what it is worth a priori: that of a quarter.
double LogPriorOf(Onset onset);

/// The time since what begins would last have been seen.
struct UnseenTime {
  double length = 0.0;     ///< [s]
  bool lacks_fix = false;  ///< one or more are missing in it
  double since = 0.0;      ///< its begin [s]

  /// Of what began in it so. Usual is at its begin, or, where it lacks a fix, at any time of
  /// it. Of a product of rate and time these are the first two moments alone: they let it
  /// jump by an error of which the rate stays, least where the time is known best.
  GrowthMoments Grown(Onset onset) const;
  /// A step of the velocity at any time of it, of a variance [m^2/s^2].
  VelocityStep StepWithin(double variance) const {
    return {.variance = variance, .begin = since, .end = since + length};
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ONSET_H_
