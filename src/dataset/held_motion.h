#ifndef HINDSIGHT_DATASET_HELD_MOTION_H_
#define HINDSIGHT_DATASET_HELD_MOTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "imu/imu_stream.h"

namespace hindsight {

/// The IMU's integrals from the begin of its record on, in the axes that the
/// gyros hold: those of the body at the begin.
class HeldMotion {
 public:
  struct Instant {
    Eigen::Quaterniond q;  ///< to the held axes from the body's
    Eigen::Vector3d v;     ///< int C f [m/s]
    Eigen::Vector3d p;     ///< int int C f [m]
  };

  /// Every 10 ms, of records longer than three hours a millionth of them; `b_g`
  /// [rad/s] is taken from the gyros.
  HeldMotion(const ImuStream& imu, const Eigen::Vector3d& b_g);

  bool Covers(double t) const { return t >= begin_ && t <= end_; }
  /// Between the points of the grid rate and force are taken as constant.
  Instant At(double t) const;

 private:
  double begin_;
  double end_;
  double step_;
  std::vector<Instant> grid_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_HELD_MOTION_H_
