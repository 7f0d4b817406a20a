#ifndef HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
#define HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_

#include <optional>
#include <vector>

#include "alignment/coarse_alignment.h"
#include "state/covariance_series.h"

namespace hindsight {

/// The motion over a window with its covariances, by all that position,
/// velocity, speed, height and standstill measurements say.
struct WindowSolution {
  ErrorLayout layout;
  std::vector<State> states;  ///< the first at input.t
  CovarianceSeries P;
  double nis = 1.0;  ///< mean normalised squared residual of a row; right is 1
};

/// Refines a coarse alignment over [input.t, t_end] with the full models of IMU
/// noise, lever arms and time offsets: forward filter and RTS pass from the
/// coarse attitude, then SmoothIterated about that from a prior which says of
/// attitude, velocity and position nothing, and of the biases what is known
/// beforehand. P therefore holds what the window tells, and no more; it is
/// scaled up by `nis` where that exceeds one. Empty if the iteration does not
/// settle.
std::optional<WindowSolution> SmoothWindow(const AlignmentInput& input,
                                           double t_end,
                                           const CoarseAlignment& coarse);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
