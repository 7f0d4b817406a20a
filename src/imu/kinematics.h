#ifndef HINDSIGHT_IMU_KINEMATICS_H_
#define HINDSIGHT_IMU_KINEMATICS_H_

#include <Eigen/Core>

namespace hindsight {

/// The IMU reading at one instant, biases not removed.
struct Kinematics {
  Eigen::Vector3d w_ib_b = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d f_b = Eigen::Vector3d::Zero();     ///< [m/s^2]
};

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_KINEMATICS_H_
