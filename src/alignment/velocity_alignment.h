#ifndef HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
#define HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_

#include "alignment/window_smoother.h"

namespace hindsight {

/// What the data of [input.t, t_end] tell of the attitude, start value or not.
struct VelocityAlignment {
  CoarseAlignment coarse;
  /// Absent where the refinement did not settle near the coarse attitude.
  std::optional<WindowSolution> refined;
  AlignedAttitude attitude;  ///< at input.t
  double t_end = 0.0;
};

/// AlignCoarsely over the window, refined by SmoothWindow. Covariance and words
/// are those of the refinement; where it does not settle, or elsewhere than the
/// coarse attitude and its covariance say, where the heading
/// sigma stays above 20 deg, or where the attitude turned by 180 deg about some
/// axis fits nearly as well (chi-square less than 25 larger) the heading counts
/// as unknown and the words name the ambiguity. Empty without enough vectors.
std::optional<VelocityAlignment> AlignOverWindow(const AlignmentInput& input,
                                                 double t_end);

/// Method `velocity`: windows of 10, 20, 40... 320 s from the first measurement
/// on, until heading and tilt are known to 0.5 deg; of these the one with the
/// smallest covariance.
AlignmentOutcome AlignByVelocity(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_VELOCITY_ALIGNMENT_H_
