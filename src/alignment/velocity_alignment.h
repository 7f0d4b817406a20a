#ifndef HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
#define HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_

#include "alignment/coarse_alignment.h"
#include "alignment/window_smoother.h"

namespace hindsight {

/// What the data of [input.t, t_end] tell of the attitude, start value or not.
struct VelocityAlignment {
  CoarseAlignment coarse;
  /// Absent where the refinement did not settle near the coarse attitude.
  std::optional<WindowSolution> refined;
  /// The gyros drift faster than stated.
  bool drifts = false;
  AlignedAttitude attitude;  ///< at input.t
  double t_end = 0.0;
};

/// AlignCoarsely over the window, refined by SmoothWindow from there, or from
/// the attitude of a shorter window, `before`, if that tells the heading: the
/// coarse alignment knows no drift of the gyros. Covariance and words are those
/// of the refinement; where it does not settle, or elsewhere than the coarse
/// attitude and its covariance say, where the heading sigma stays above 20 deg,
/// or where the attitude turned by 180 deg about some axis fits nearly as well
/// (chi-square less than 25 larger) the heading counts as unknown and the words
/// name the ambiguity. Empty without enough vectors.
std::optional<VelocityAlignment> AlignOverWindow(
    const AlignmentInput& input, double t_end,
    const VelocityAlignment* before = nullptr);

/// Method `velocity`: windows of 10, 20, 40... 320 s from the first measurement
/// on, until heading and tilt are known to 0.5 deg, and one more; of these the
/// one with the smallest covariance. A window whose attitude is more than five
/// sigmas from that of the best shorter one ends the search: it has outlasted
/// its model. After a rest at input.t the windows begin a second before its
/// end, with GyroBiasAfterRest: what does not turn has one attitude. Gyros that
/// drift, drift in every window, also where it does not show: if the rest does
/// (DriftAtRest), or a window, or the contradiction of two, all windows are
/// smoothed with at least that window's walk, else WarmUpWalk.
AlignmentOutcome AlignByVelocity(const AlignmentInput& input);

/// The first measurement of motion at input.t or later; input.to without any.
double FirstMotion(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
