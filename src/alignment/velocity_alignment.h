#ifndef HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
#define HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `velocity`: AlignmentWindows of 10, 20, 40... 320 s from the first
/// measurement on, until heading and tilt are known to 0.5 deg, and one more;
/// of these the one with the smallest covariance. A window whose attitude is
/// more than five sigmas from that of the best shorter one ends the search: it
/// has outlasted its model. After a rest at input.t the windows begin a second
/// before its end, with GyroBiasAfterRest: what does not turn has one attitude.
/// Gyros that drift, drift in every window, also where it does not show: if the
/// rest does (DriftAtRest), or a window, or the contradiction of two, all
/// windows are smoothed with at least that window's walk, else WarmUpWalk.
AlignmentOutcome AlignByVelocity(const AlignmentInput& input);

/// The first measurement of motion at input.t or later; input.to without any.
double FirstMotion(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
