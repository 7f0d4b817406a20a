#ifndef HINDSIGHT_EVALUATION_EULER_ERROR_H_
#define HINDSIGHT_EVALUATION_EULER_ERROR_H_

#include <Eigen/Core>

namespace hindsight {

/// J with d(roll, pitch, heading) = J psi, for C_nb = Exp(psi) C^_nb and psi
/// resolved in NED [rad]. With s, c of heading and pitch:
///       |  c_h/c_p      s_h/c_p     0 |
///   J = | -s_h          c_h         0 |
///       |  c_h t_p      s_h t_p     1 |
/// `euler` is (roll, pitch, heading) [rad]. Grows without bound towards
/// pitch = +-90 deg, where roll and heading are not separate.
Eigen::Matrix3d EulerErrorJacobian(const Eigen::Vector3d& euler);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_EULER_ERROR_H_
