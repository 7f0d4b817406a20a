#ifndef HINDSIGHT_ATTITUDE_ACCEL_BIAS_FIT_H_
#define HINDSIGHT_ATTITUDE_ACCEL_BIAS_FIT_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "imu/imu_stream.h"

namespace hindsight {

/// A bias of the accelerometers that the size of what they read in many
/// attitudes shows.
struct AccelBiasFit {
  /// What it is along those principal axes of P of which it is known to be three
  /// sigmas or more; a level body knows nothing of the vertical one [m/s^2].
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();
  /// b' P^-1 b; of chance alone a chi-square of three degrees of freedom.
  double significance = 0.0;
};

/// Least squares over means of a second of the vertical specific force,
///   (C_nb (f_b - b_0))_z + g = (C_nb)_z b + c + a_z,
/// which an error of tilt does not enter to first order: b the bias beside the `known` b_0, c an error of
/// gravity or scale, a_z what the body accelerates. A mean has the variance of its
/// second, as the motions of a hand go with its attitude and hardly average out,
/// or that of the residuals if it is larger. `q_nb` is the attitude at every sample, `gravity` [m/s^2]. A
/// body that hardly turns tells nothing: the significance is near 0.
AccelBiasFit FitAccelBias(const ImuStream& imu,
                          std::span<const Eigen::Quaterniond> q_nb,
                          double gravity, const Eigen::Vector3d& known);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ACCEL_BIAS_FIT_H_
