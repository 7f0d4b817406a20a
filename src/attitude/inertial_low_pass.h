#ifndef HINDSIGHT_ATTITUDE_INERTIAL_LOW_PASS_H_
#define HINDSIGHT_ATTITUDE_INERTIAL_LOW_PASS_H_

#include <Eigen/Core>
#include <cmath>

namespace hindsight {

/// A specific force [f, d f / d b_a] in some axes: f is what accelerometers read
/// there [m/s^2], b_a their bias in body axes [m/s^2].
using BiasedForce = Eigen::Matrix<double, 3, 4>;
/// A reading f_b in body axes.
inline BiasedForce ForceAsRead(const Eigen::Vector3d& f_b) {
  BiasedForce force;
  force << f_b, Eigen::Matrix3d::Identity();
  return force;
}

/// Second-order Butterworth low-pass of a force resolved in axes that do not
/// turn with the body (the gyro-integrated quasi-inertial frame of VQF): there
/// the linear acceleration of a body that stays about averages out and gravity
/// does not move. Time constant tau = sqrt(2)/(2 pi f_c). For the first tau the
/// output is the running mean, which has no transient.
class InertialLowPass {
 public:
  /// Of samples `dt` apart; both [s].
  InertialLowPass(double tau, double dt) : tau_(tau), dt_(dt) {
    const double C = std::tan(std::sqrt(2.0) * dt / (2.0 * tau));
    const double D = C * C + std::sqrt(2.0) * C + 1.0;
    b0_ = C * C / D;
    a1_ = 2.0 * (C * C - 1.0) / D;
    a2_ = (1.0 - std::sqrt(2.0) * C + C * C) / D;
  }

  const BiasedForce& Filter(const BiasedForce& x) {
    if (age_ < tau_) {
      age_ += dt_;
      sum_ += x;
      y_ = sum_ * (dt_ / age_);
      // The state whose steady output is y.
      s0_ = (1.0 - b0_) * y_;
      s1_ = (b0_ - a2_) * y_;
      return y_;
    }
    y_ = b0_ * x + s0_;
    s0_ = 2.0 * b0_ * x - a1_ * y_ + s1_;
    s1_ = b0_ * x - a2_ * y_;
    return y_;
  }

 private:
  double tau_, dt_;
  double b0_, a1_, a2_;
  double age_ = 0.0;
  BiasedForce sum_ = BiasedForce::Zero();
  BiasedForce y_ = BiasedForce::Zero();
  BiasedForce s0_ = BiasedForce::Zero();
  BiasedForce s1_ = BiasedForce::Zero();
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_INERTIAL_LOW_PASS_H_
