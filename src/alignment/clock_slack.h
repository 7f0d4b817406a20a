#ifndef HINDSIGHT_ALIGNMENT_CLOCK_SLACK_H_
#define HINDSIGHT_ALIGNMENT_CLOCK_SLACK_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dataset/dataset.h"

namespace hindsight {

/// A start that is found from positions and velocities is that of another time
/// by the error of their clock: the largest a priori sigma of those clocks [s],
/// 0 where all are known.
double ClockSigma(const Dataset& dataset);

/// Turn of the body within `seconds` at t [NED, rad]: the mean rate of the
/// second about t, less the bias [rad/s].
Eigen::Vector3d TurnWithin(double seconds, const ImuStream& imu, double t,
                           const Eigen::Quaterniond& q_nb,
                           const Eigen::Vector3d& b_g);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_CLOCK_SLACK_H_
