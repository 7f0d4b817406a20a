#include "attitude/attitude_filter.h"

#include <algorithm>
#include <cmath>

#include "attitude/rest_detector.h"
#include "geometry/so3.h"
#include "imu/imu_noise.h"
#include "imu/rotation_summary.h"

namespace hindsight {

AttitudeFilter::AttitudeFilter(const AttitudeFilterOptions& options,
                               const ImuNoise& noise,
                               const AttitudeState& start,
                               double sample_interval)
    : options_(options),
      noise_(noise),
      bias_evolution_(noise.GyroBiasEvolution()),
      accel_evolution_(noise.AccelBiasEvolution()),
      rule_(MakeAccelerometerRule(options.rule)),
      reference_(options.reference),
      q_ni_(start.q_nb),
      q_ib_(Eigen::Quaterniond::Identity()),
      C_ib_(Eigen::Matrix3d::Identity()),
      t_(start.t),
      b_g_(start.b_g),
      s_g_(start.s_g),
      b_a_(start.b_a),
      dip_(std::atan2(options.magnetic.down, options.magnetic.horizontal)),
      P_(start.P),
      unscale_((1.0 + start.s_g.array()).inverse().matrix()),
      // White noise through a low-pass of the first order.
      rate_sigma_(std::sqrt(0.5 * GyroWhiteNoise(noise, 0.0) /
                            RestDetector::kSmoothing)),
      dt_(std::max(sample_interval, options.update_interval)),
      field_t_(start.t) {
  P_(AttitudeState::kDip, AttitudeState::kDip) =
      options.dip_sigma * options.dip_sigma;
  if (options.low_pass_tau > 0.0) {
    low_pass_.emplace(options.low_pass_tau, sample_interval);
  }
}

void AttitudeFilter::Turn(double dt, const Eigen::Vector3d& w0,
                          const Eigen::Vector3d& w1) {
  const RotationSummary summary = SummarizeRotation(
      noise_, dt, unscale_.cwiseProduct(w0 - b_g_),
      unscale_.cwiseProduct(w1 - b_g_), Eigen::Vector3d::Zero());
  const Eigen::Matrix3d C_before = C_ib_;
  if (resting_) {
    const Eigen::Vector3d earth_b =
        C_ib_.transpose() * (q_ni_.conjugate() * options_.place.w_ie_n);
    q_ib_ = q_ib_ * Exp(dt * earth_b);
    turned_.rest_w += w1;
    ++turned_.resting;
  } else {
    q_ib_ = q_ib_ * Exp(summary.phi);
  }
  q_ib_.coeffs() *= 1.5 - 0.5 * q_ib_.squaredNorm();
  C_ib_ = q_ib_.toRotationMatrix();
  if (!resting_) {
    const Eigen::Matrix3d C = 0.5 * turned_.phi * (C_before + C_ib_);
    turned_.A.noalias() -= dt * C;
    turned_.S.noalias() -= C * summary.phi.asDiagonal();
    turned_.angle += summary.phi.norm();
  }
  turned_.q_attitude += summary.variance;
  turned_.dt += dt;
  ++turned_.samples;
  if (bias_evolution_.StationaryVariance() > 0.0) {
    const double phi = bias_evolution_.Phi(dt);
    turned_.phi *= phi;
    b_g_ *= phi;
  }
  t_ += dt;
}

void AttitudeFilter::Predict() {
  predicted_ = turned_;
  turned_ = Interval();
  if (predicted_.samples == 0) return;
  dt_ = predicted_.dt;
  transition_.phi = predicted_.phi;
  transition_.q_attitude = predicted_.q_attitude;
  transition_.q_bias = bias_evolution_.Q(dt_);
  transition_.phi_accel = accel_evolution_.Phi(dt_);
  transition_.q_accel_bias = accel_evolution_.Q(dt_);
  b_a_ *= transition_.phi_accel;
  LearnDip();
  if (!options_.place.w_ie_n.isZero(0.0)) {
    q_ni_ = Exp(-dt_ * options_.place.w_ie_n) * q_ni_;
  }
  const Eigen::Matrix3d C_ni = q_ni_.toRotationMatrix();
  Eigen::Matrix<double, 3, 6>& A = transition_.A;
  A << C_ni * predicted_.A, C_ni * predicted_.S;

  constexpr int kBiases = AttitudeState::kDim - 3;
  const Eigen::Matrix<double, 6, kBiases> P_gc =
      P_.middleRows<6>(AttitudeState::kGyroBias).rightCols<kBiases>();
  const Eigen::Matrix<double, 3, kBiases> P_ac =
      P_.topRightCorner<3, kBiases>();
  const Eigen::Matrix<double, 3, kBiases> AP_gc = A * P_gc;
  const Eigen::Matrix3d AP_ga = A * P_ac.leftCols<6>().transpose();
  P_.topLeftCorner<3, 3>() +=
      AP_ga + AP_ga.transpose() + AP_gc.leftCols<6>() * A.transpose();
  P_.topRightCorner<3, kBiases>() = P_ac + AP_gc;
  P_.bottomLeftCorner<kBiases, 3>() =
      P_.topRightCorner<3, kBiases>().transpose();
  Scale(AttitudeState::kGyroBias, transition_.phi);
  Scale(AttitudeState::kAccelBias, transition_.phi_accel);
  if (transition_.learns_dip) {
    constexpr int kDip = AttitudeState::kDip;
    P_.row(kDip) = transition_.dip_by_psi.transpose() * P_.topRows<3>();
    P_.col(kDip) = P_.row(kDip).transpose();
    P_(kDip, kDip) =
        transition_.dip_by_psi.dot(P_.col(kDip).head<3>()) + transition_.q_dip;
  }
  P_.diagonal().head<3>().array() += transition_.q_attitude;
  P_.diagonal().segment<3>(AttitudeState::kGyroBias).array() +=
      transition_.q_bias;
  P_.diagonal().segment<3>(AttitudeState::kAccelBias).array() +=
      transition_.q_accel_bias;
}

void AttitudeFilter::LearnDip() {
  transition_.learns_dip = reference_.adoptions() != adoptions_;
  if (!transition_.learns_dip) return;
  adoptions_ = reference_.adoptions();
  dip_ = reference_.dip();
  const double declination = options_.magnetic.declination;
  transition_.dip_by_psi = {std::sin(declination), -std::cos(declination), 0.0};
  const double sigma = options_.magnetic_sigma / reference_.norm();
  transition_.q_dip = sigma * sigma *
                      std::min(1.0, options_.magnetic_correlation_time /
                                        options_.reference.first_adoption);
}

void AttitudeFilter::Scale(int begin, double phi) {
  if (phi == 1.0) return;
  P_.middleCols<3>(begin) *= phi;
  P_.middleRows<3>(begin) *= phi;
}

void AttitudeFilter::Reset() {
  q_ni_ = Exp(dx_.head<3>()) * q_ni_;
  q_ni_.coeffs() *= 1.5 - 0.5 * q_ni_.squaredNorm();
  b_g_ += dx_.segment<3>(AttitudeState::kGyroBias);
  s_g_ += dx_.segment<3>(AttitudeState::kGyroScale);
  b_a_ += dx_.segment<3>(AttitudeState::kAccelBias);
  dip_ += dx_(AttitudeState::kDip);
  unscale_ = (1.0 + s_g_.array()).inverse().matrix();
  dx_.setZero();
}

AttitudeState AttitudeFilter::state() const {
  return {t_, q_ni_ * q_ib_, b_g_, s_g_, b_a_, P_};
}

}  // namespace hindsight
