#ifndef HINDSIGHT_RECEIVER_ERRORS_TOLD_VELOCITY_STEP_H_
#define HINDSIGHT_RECEIVER_ERRORS_TOLD_VELOCITY_STEP_H_

#include <Eigen/Core>

#include "timeline/velocity_step.h"

namespace hindsight {

/// A step of the IMU's velocity that a hypothesis has.
struct ToldVelocityStep {
  VelocityStep step;
  /// What the vehicle's velocity has changed by more than the IMU tells, as smoothed,
  /// NED [m/s].
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_TOLD_VELOCITY_STEP_H_
