#ifndef HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_
#define HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_

#include <Eigen/Core>
#include <cmath>

#include "attitude/attitude_filter.h"

namespace hindsight {

/// Covariance of an attitude with what P leaves out: an error of heading [rad]
/// that all attitudes share, and, where the heading was taken from the field as
/// if the tilt were known, the turn by which the tilt's error levels the field,
///   psi_D += slope (cos(declination) psi_N + sin(declination) psi_E),
/// `slope` = down / horizontal; 0: the tilt's error was counted.
class SharedCovariance {
 public:
  SharedCovariance(const AttitudeFilterOptions& options, double slope) {
    const double declination = options.magnetic.declination;
    turn_.row(2).head<2>() << slope * std::cos(declination),
        slope * std::sin(declination);
  }
  /// P of attitude and gyro bias; the sigma of what headings share [rad].
  void AddTo(double heading_sigma, Eigen::Matrix<double, 6, 6>* P) const {
    P->topRows<3>() = (turn_ * P->topRows<3>()).eval();
    P->leftCols<3>() = (P->leftCols<3>() * turn_.transpose()).eval();
    (*P)(2, 2) += heading_sigma * heading_sigma;
  }

 private:
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SHARED_COVARIANCE_H_
