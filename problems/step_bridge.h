#ifndef HINDSIGHT_PROBLEMS_STEP_BRIDGE_H_
#define HINDSIGHT_PROBLEMS_STEP_BRIDGE_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "timeline/timeline.h"

namespace hindsight {

/// What the velocity steps of an interval have done by a time t in it, (position, velocity)
/// an axis, given all that they do by its end: with S_t and S what they are by either
/// (VelocityStep::Within) and F the motion from t to the end,
///   gain = S_t F' S^-1,   covariance = S_t - gain F S_t.
struct StepBridge {
  Eigen::Matrix2d gain;
  Eigen::Matrix2d covariance;
  int position;  ///< of the layout, its first component
  int velocity;  ///< the same
};

/// Between node k and the next, t [s]; none where the timeline has no steps there, or the
/// layout lacks an axis of the position or the velocity.
std::optional<StepBridge> BridgeOverSteps(const ErrorLayout& layout,
                                          const Timeline& timeline,
                                          std::size_t k, double t);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_STEP_BRIDGE_H_
