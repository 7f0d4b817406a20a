#ifndef HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_
#define HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "attitude/attitude_filter.h"

namespace hindsight {

/// Covariance of what all attitudes of a solution share beside P: an error of
/// heading [rad], and the tilt of an accelerometer bias b,
///   psi = (e_D x C_nb b) / -g,
/// by its a priori sigma [m/s^2, body axes]. The tilt levels the field so as to
/// turn the heading with it, by `slope` = down / horizontal; 0: there is no field.
class SharedCovariance {
 public:
  SharedCovariance(const Eigen::Vector3d& accel_bias_sigma,
                   const AttitudeFilterOptions& options, double heading_sigma,
                   double slope)
      : bias_sigma_(accel_bias_sigma),
        heading_variance_(heading_sigma * heading_sigma) {
    const double g = options.place.gravity;
    const double declination = options.magnetic.declination;
    by_bias_n_.row(0) << 0.0, 1.0 / g, 0.0;
    by_bias_n_.row(1) << -1.0 / g, 0.0, 0.0;
    by_bias_n_.row(2) = slope * (std::cos(declination) * by_bias_n_.row(0) +
                                 std::sin(declination) * by_bias_n_.row(1));
  }
  /// P of attitude and gyro bias at the attitude q_nb.
  void AddTo(const Eigen::Quaterniond& q_nb,
             Eigen::Matrix<double, 6, 6>* P) const {
    (*P)(2, 2) += heading_variance_;
    const Eigen::Matrix3d root =
        by_bias_n_ * q_nb.toRotationMatrix() * bias_sigma_.asDiagonal();
    P->topLeftCorner<3, 3>().noalias() += root * root.transpose();
  }

 private:
  Eigen::Vector3d bias_sigma_;
  double heading_variance_;
  Eigen::Matrix3d by_bias_n_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_
