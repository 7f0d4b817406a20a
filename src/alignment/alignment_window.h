#ifndef HINDSIGHT_ALIGNMENT_ALIGNMENT_WINDOW_H_
#define HINDSIGHT_ALIGNMENT_ALIGNMENT_WINDOW_H_

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

/// AlignCoarsely over a window, refined by WindowSmoother.
class AlignmentWindow {
 public:
  /// [input.t, t_end]; `input` must outlive it.
  AlignmentWindow(const AlignmentInput& input, double t_end);

  /// With gyro bias walks of at least `least_walk` [rad/s/sqrt(s)], from the
  /// coarse alignment or from the attitude of a shorter window, `before`, if
  /// that tells the heading: the coarse alignment knows no drift of the gyros.
  /// Covariance and words are those of the refinement; where it does not
  /// settle, or elsewhere than the coarse attitude and its covariance say,
  /// where the heading sigma stays above 20 deg, or where the attitude turned
  /// by 180 deg about some axis fits nearly as well (chi-square less than 25
  /// larger) the heading counts as unknown and the words name the ambiguity.
  /// Empty without enough vectors.
  std::optional<VelocityAlignment> Align(
      double least_walk, const VelocityAlignment* before = nullptr);

 private:
  const AlignmentInput& input_;
  double t_end_;
  std::optional<CoarseAlignment> coarse_;
  WindowSmoother smoother_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_ALIGNMENT_WINDOW_H_
