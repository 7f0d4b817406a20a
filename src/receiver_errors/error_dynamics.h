#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_DYNAMICS_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_DYNAMICS_H_

#include <Eigen/Core>

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/onset.h"

namespace hindsight {

/// With which the rate of a drift walks, in its sigma [1/sqrt(s)]. A drift that
/// bends more is one of several pieces: what bends freely explains any
/// correlated noise.
inline constexpr double kDriftWalk = 1e-3;

/// Over an interval, an axis:
///   e' = ee e + er r + w_e,   r' = rr r + w_r,
///   cov(w_e, w_r) = (q_ee, q_er; q_er, q_rr),
/// and a jump of the velocity of variance q_vv. Down, the third axis, w_e has `down` times
/// the sigma of the others. Of a drift of a new rate r ~ N(0, s^2), which has grown for an
/// unknown part of the time `unseen`, q_ee and q_er are s^2 times UnseenTime::Grown, and q_rr
/// is s^2.
struct ErrorDynamics {
  double ee = 0.0, er = 0.0, rr = 0.0;
  double q_ee = 0.0, q_er = 0.0, q_rr = 0.0;
  double q_vv = 0.0;
  double down = 1.0;
};
ErrorDynamics DynamicsOf(const ErrorParameters& parameters, ErrorStep step,
                         double dt, const UnseenTime& unseen);

/// Of w_e, by axis.
Eigen::Vector3d ErrorVariances(const ErrorDynamics& d);
/// Of (e, r), three axes each: the transition and the covariance of the noise.
Eigen::Matrix<double, 6, 6> ErrorPhi(const ErrorDynamics& d);
Eigen::Matrix<double, 6, 6> ErrorQ(const ErrorDynamics& d);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_DYNAMICS_H_
