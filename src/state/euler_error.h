#ifndef HINDSIGHT_STATE_EULER_ERROR_H_
#define HINDSIGHT_STATE_EULER_ERROR_H_

#include <Eigen/Core>

#include "base/units.h"
#include "state/state.h"

namespace hindsight {

/// Standard deviation of an angle of which nothing is known: uniform on a
/// circle, 360 deg/sqrt(12) [rad].
inline constexpr double kUnknownAngleSigma =
    2.0 * kPi / 3.4641016151377545870548926830117;

/// J with d(roll, pitch, heading) = J phi, for C_nb = Exp(phi) C^_nb and phi
/// resolved in NED [rad]. With s, c, t of heading and pitch:
///       |  c_h/c_p      s_h/c_p     0 |
///   J = | -s_h          c_h         0 |
///       |  c_h t_p      s_h t_p     1 |
/// `euler` is (roll, pitch, heading) [rad]. Grows without bound towards
/// pitch = +-90 deg, where roll and heading are not separate.
Eigen::Matrix3d EulerErrorJacobian(const Eigen::Vector3d& euler);

/// Standard deviations of x.euler() (roll, pitch, heading) [rad] from the
/// covariance P of x over a layout with a complete attitude. The angles are
/// against the NED axes of a position that is itself uncertain, which turn by
/// dtheta = D dr from the estimated to the true one, so that
///   d(roll, pitch, heading) = J (psi - D dr),
///   D dr = (dr_E/(R_t + h), -dr_N/(R_m + h), -dr_E tan(latitude)/(R_t + h)).
/// A layout without a complete position has no such turn. Towards pitch
/// +-90 deg those of roll and heading grow as 1/cos(pitch); none is larger than
/// kUnknownAngleSigma.
Eigen::Vector3d EulerSigma(const ErrorLayout& layout, const State& x,
                           const ErrorMatrix& P);

/// The same from a covariance of phi alone.
Eigen::Vector3d EulerSigma(const Eigen::Vector3d& euler,
                           const Eigen::Matrix3d& P_phi);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_EULER_ERROR_H_
