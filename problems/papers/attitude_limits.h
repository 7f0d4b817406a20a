#ifndef HINDSIGHT_PROBLEMS_PAPERS_ATTITUDE_LIMITS_H_
#define HINDSIGHT_PROBLEMS_PAPERS_ATTITUDE_LIMITS_H_

#include "base/units.h"

namespace hindsight {

/// Largest tilt and heading error [rad].
struct AttitudeLimits {
  double tilt;
  double heading;

  bool Hold(double of_tilt, double of_heading) const {
    return of_tilt <= tilt && of_heading <= heading;
  }
};

inline constexpr AttitudeLimits kSettledAttitude = {0.5 * kDegree,
                                                    2.0 * kDegree};
/// A run that exceeds these in its last kDecidingEnd seconds has diverged.
inline constexpr AttitudeLimits kDivergedAttitude = {2.0 * kDegree,
                                                     10.0 * kDegree};
inline constexpr double kDecidingEnd = 20.0;

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_ATTITUDE_LIMITS_H_
