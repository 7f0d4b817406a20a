#include "receiver_errors/error_dynamics.h"

#include <cmath>

namespace hindsight {

ErrorDynamics DynamicsOf(const ErrorParameters& p, ErrorStep step, double dt,
                         const UnseenTime& unseen) {
  ErrorDynamics d;
  d.q_vv = step.velocity_step ? p.rate_sigma * p.rate_sigma : 0.0;
  switch (step.mode) {
    case ErrorMode::kGood:
      break;
    case ErrorMode::kBiased:
    case ErrorMode::kSlight: {
      const bool slight = step.mode == ErrorMode::kSlight;
      const double sigma = slight ? p.slight_sigma : p.sigma;
      const double tau = slight ? p.slight_tau : p.tau;
      d.ee = step.anew ? 0.0 : std::exp(-dt / tau);
      d.q_ee = sigma * sigma * (1.0 - d.ee * d.ee);
      d.down = slight ? 1.0 : p.down;
      break;
    }
    case ErrorMode::kDrifting: {
      const double rate = p.rate_sigma * p.rate_sigma;
      d.ee = 1.0;
      d.er = step.anew ? 0.0 : dt;
      d.rr = step.anew ? 0.0 : 1.0;
      d.q_rr = step.anew ? rate : rate * kDriftWalk * kDriftWalk * dt;
      if (step.anew) {
        const GrowthMoments grown = unseen.Grown(step.onset);
        d.q_er = rate * grown.by_rate;
        d.q_ee = rate * grown.square;
      }
      break;
    }
  }
  return d;
}

Eigen::Vector3d ErrorVariances(const ErrorDynamics& d) {
  return {d.q_ee, d.q_ee, d.down * d.down * d.q_ee};
}

Eigen::Matrix<double, 6, 6> ErrorPhi(const ErrorDynamics& d) {
  Eigen::Matrix<double, 6, 6> Phi = Eigen::Matrix<double, 6, 6>::Zero();
  Phi.topLeftCorner<3, 3>().diagonal().setConstant(d.ee);
  Phi.topRightCorner<3, 3>().diagonal().setConstant(d.er);
  Phi.bottomRightCorner<3, 3>().diagonal().setConstant(d.rr);
  return Phi;
}

Eigen::Matrix<double, 6, 6> ErrorQ(const ErrorDynamics& d) {
  Eigen::Matrix<double, 6, 6> Q = Eigen::Matrix<double, 6, 6>::Zero();
  Q.topLeftCorner<3, 3>().diagonal() = ErrorVariances(d);
  Q.topRightCorner<3, 3>().diagonal().setConstant(d.q_er);
  Q.bottomLeftCorner<3, 3>().diagonal().setConstant(d.q_er);
  Q.bottomRightCorner<3, 3>().diagonal().setConstant(d.q_rr);
  return Q;
}

}  // namespace hindsight
