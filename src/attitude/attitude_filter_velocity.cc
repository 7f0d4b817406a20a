#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "attitude/attitude_filter.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/tilt.h"

namespace hindsight {

AttitudeFilter::VelocityStart AttitudeFilter::StartAt(
    const VelocitySample& reading, const Eigen::Vector3d& w_b) const {
  VelocityStart start;
  start.reading = reading;
  start.force = force_;
  start.force.Add(reading.t - t_, raw_f_i_,
                  resting_ ? Eigen::Matrix3d::Zero().eval() : C_ib_);
  const Eigen::Vector3d w_ib = unscale_.cwiseProduct(w_b - b_g_);
  start.lever_i = C_ib_ * w_ib.cross(reading.lever_arm_b);
  start.lever_by_bias = C_ib_ * Skew(reading.lever_arm_b);
  return start;
}

void AttitudeFilter::BeginVelocity(const VelocitySample& reading,
                                   const Eigen::Vector3d& w_b) {
  velocity_ = StartAt(reading, w_b);
}

void AttitudeFilter::UseVelocity(const VelocitySample& reading,
                                 const Eigen::Vector3d& w_b) {
  const VelocityStart before = velocity_;
  velocity_ = StartAt(reading, w_b);
  const double dt = reading.t - before.reading.t;
  const Eigen::Matrix3d C_ni = q_ni_.toRotationMatrix();
  const Eigen::Vector3d u_n = C_ni * (velocity_.force.f - before.force.f +
                                      velocity_.lever_i - before.lever_i);
  const Eigen::Vector3d mean_v = 0.5 * (reading.v_n + before.reading.v_n);
  Eigen::Vector3d turning = 2.0 * options_.place.w_ie_n;
  if (!turning.isZero(0.0)) {
    turning += TransportRate_n(GeodeticFromEcef(options_.place.p_e), mean_v);
  }
  const Eigen::Vector3d expected =
      reading.v_n - before.reading.v_n +
      dt * (turning.cross(mean_v) + ForceAtRest_n(options_.place.gravity));
  const double g = options_.place.gravity;
  constexpr double kManoeuvre = 30.0;  // [s]
  const double white =
      std::pow(noise_.accel_noise_density, 2) +
      std::pow(options_.accel_bias_sigma, 2) * std::max(kManoeuvre, dt) +
      std::pow(g * noise_.gyro_noise_density * dt, 2) / 3.0;
  const Eigen::Matrix3d R = reading.R_n + before.reading.R_n +
                            dt * white * Eigen::Matrix3d::Identity();
  const Eigen::LLT<Eigen::Matrix3d> llt(R);
  Eigen::Matrix<double, 3, AttitudeState::kDim> H;
  H << -Skew(u_n),
      C_ni * (velocity_.force.ByBias(before.force) + velocity_.lever_by_bias -
              before.lever_by_bias +
              Skew(before.lever_i) * (velocity_.force.C - before.force.C)),
      Eigen::Matrix3d::Zero();
  const Eigen::Vector3d residual = llt.matrixL().solve(expected - u_n);
  H = llt.matrixL().solve(H).eval();
  for (int row = 0; row < 3; ++row) {
    UpdateState(H.row(row).transpose(), residual(row), 1.0);
  }
}

}  // namespace hindsight
