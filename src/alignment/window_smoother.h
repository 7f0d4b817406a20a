#ifndef HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
#define HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_

#include <optional>
#include <vector>

#include "alignment/alignment.h"
#include "state/covariance_series.h"

namespace hindsight {

/// The motion over a window with its covariances, by all that position,
/// velocity, speed, height and standstill measurements say.
struct WindowSolution {
  ErrorLayout layout;
  std::vector<State> states;  ///< the first at input.t
  CovarianceSeries P;
  double nis = 1.0;  ///< mean normalised squared residual of a row; right is 1
  /// Of all measurements, linearised about the solution.
  double log_likelihood = 0.0;
  /// With which the gyro biases were let drift [rad/s/sqrt(s)].
  double gyro_bias_walk = 0.0;
};

/// Where a refinement begins: near the truth, P of psi in NED axes.
struct WindowStart {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();    ///< [rad^2]
};

/// The attitude at input.t as it is known beforehand, and its covariance.
struct AttitudePrior {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
};

/// With which a gyro bias changes in a minute by its a priori sigma (the worst
/// axis), for both come from temperature [rad/s/sqrt(s)].
double WarmUpWalk(const AlignmentInput& input);

/// Refines an attitude over [input.t, t_end] with the full models of IMU noise,
/// lever arms and time offsets: forward filter and RTS pass from the start,
/// then SmoothIterated about that from a prior which says of velocity and
/// position nothing, of the attitude nothing but `known`, and of the biases
/// GyroBiasBefore and the configuration say. P therefore holds what the window
/// tells, and no more; it is scaled up by `nis` where that exceeds one, and of
/// the heading it claims what the likelihood has (WidenHeading). A gyro
/// that warms up drifts faster than its data sheet says: besides with the
/// stated walk the window is smoothed with walks of 0.003 to 0.3 deg/s/sqrt(s),
/// at most five times WarmUpWalk, and a larger one is taken where it raises the
/// log-likelihood, over `nis`, by more than 5. A steady drift looks like a
/// small walk, whose independent steps carry it on far too surely to where it
/// is not seen: of the walks up to WarmUpWalk the largest is taken that lowers
/// the log-likelihood by less than that again. The stated walk counts as
/// AlignmentInput::least_gyro_walk if that is larger. Empty if no iteration
/// settles.
std::optional<WindowSolution> SmoothWindow(
    const AlignmentInput& input, double t_end, const WindowStart& start,
    const std::optional<AttitudePrior>& known = std::nullopt);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_WINDOW_SMOOTHER_H_
