#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_SMOOTHER_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_SMOOTHER_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "attitude/attitude_run.h"

namespace hindsight {

/// A node of a run, smoothed.
struct SmoothedAttitude {
  /// Mean of the error about the filter's state after the update.
  AttitudeState::Vector d = AttitudeState::Vector::Zero();
  AttitudeState::Matrix P = AttitudeState::Matrix::Zero();
};

/// The smoother of Rauch, Tung and Striebel in the form of Bryson and Frazier
/// (Bierman 1973), which needs no inverse: with F the transition and K = P h /
/// S of each scalar reading,
///   lambda <- F' lambda,                     Lambda <- F' Lambda F,
///   lambda <- lambda + h (i / S - K' lambda),
///   Lambda <- (I - K h')' Lambda (I - K h') + h h' / S
/// backwards from zero at the end, and at each node
///   d = P lambda,   P_s = P - P Lambda P.
/// A component that the readings make sharper by a factor r loses r^2 of the
/// digits. The run must have been recorded to be smoothed.
std::vector<SmoothedAttitude> SmoothAttitude(const AttitudeRun& run,
                                             bool covariances = true);

/// Smoothed state of a node.
AttitudeState StateOf(const AttitudeRun& run,
                      const std::vector<SmoothedAttitude>& smoothed,
                      std::size_t node);

/// Smoothed attitude at every sample; between two nodes the error, about what
/// the gyros say from the first, changes linearly.
std::vector<Eigen::Quaterniond> AttitudesAtSamples(
    const AttitudeRun& run, const std::vector<SmoothedAttitude>& smoothed,
    const ImuStream& imu);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_SMOOTHER_H_
