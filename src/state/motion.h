#ifndef HINDSIGHT_STATE_MOTION_H_
#define HINDSIGHT_STATE_MOTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hindsight {

/// True motion of the IMU at one instant. v_e is the derivative of p_e, a_e of
/// v_e, and C_eb' = C_eb [w_eb_b x].
struct Motion {
  double t = 0.0;                                    ///< [s]
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();     ///< [m]
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();     ///< [m/s]
  Eigen::Vector3d a_e = Eigen::Vector3d::Zero();     ///< [m/s^2]
  Eigen::Vector3d w_eb_b = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_MOTION_H_
