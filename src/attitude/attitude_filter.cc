#include "attitude/attitude_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "attitude/rest_detector.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "imu/imu_noise.h"
#include "imu/rotation_summary.h"
#include "measurements/tilt.h"

namespace hindsight {

namespace {

/// Variance of the mean of `count` readings within dt, in that of one, if their
/// errors go on for `time`.
double Inflation(double time, double dt, int count) {
  return std::max(1.0 / count, dt > 0.0 ? time / dt : 0.0);
}

}  // namespace

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

void AttitudeFilter::Record(const Vector& h, const Vector& PHt, double S,
                            double innovation) {
  if (record_ != nullptr) record_->push_back({h, PHt, S, innovation});
}

void AttitudeFilter::ApplyGain(const Vector& PHt, double S, double innovation) {
  const Vector K = PHt / S;
  dx_ += innovation * K;
  P_.noalias() -= K * PHt.transpose();
}

double AttitudeFilter::UpdateComponent(int i, double h, double residual,
                                       double R) {
  const Vector PHt = h * P_.col(i);
  const double S = h * PHt(i) + R;
  const double innovation = residual - h * dx_(i);
  Record(h * Vector::Unit(i), PHt, S, innovation);
  ApplyGain(PHt, S, innovation);
  return innovation / std::sqrt(S);
}

double AttitudeFilter::UpdateState(const Vector& h, double residual, double R) {
  const Vector PHt = P_ * h;
  const double S = h.dot(PHt) + R;
  const double innovation = residual - h.dot(dx_);
  Record(h, PHt, S, innovation);
  ApplyGain(PHt, S, innovation);
  return innovation / std::sqrt(S);
}

double AttitudeFilter::UpdateAttitude(const Eigen::Vector3d& h, double residual,
                                      double R) {
  const Vector PHt = P_.leftCols<3>() * h;
  const double S = h.dot(PHt.head<3>()) + R;
  const double innovation = residual - h.dot(dx_.head<3>());
  Vector full = Vector::Zero();
  full.head<3>() = h;
  Record(full, PHt, S, innovation);
  ApplyGain(PHt, S, innovation);
  return innovation / std::sqrt(S);
}

double AttitudeFilter::ConsiderTilt(const Eigen::Vector3d& h, double residual,
                                    double R) {
  const Vector PHt = P_.leftCols<3>() * h;
  const double S = h.dot(PHt.head<3>()) + R;
  Vector K = PHt / S;
  K.head<2>().setZero();
  K.segment<3>(AttitudeState::kAccelBias).setZero();
  const double innovation = residual - h.dot(dx_.head<3>());
  dx_ += innovation * K;
  P_ += S * K * K.transpose() - K * PHt.transpose() - PHt * K.transpose();
  return innovation / std::sqrt(S);
}

void AttitudeFilter::AddForce(const BiasedForce& force) {
  if (low_pass_) {
    force_ = low_pass_->Filter(C_ib_ * force);
  } else {
    force_ = force;
    C_if_ = C_ib_;
  }
  const double s =
      std::abs(WithoutBias(force_).norm() - options_.place.gravity);
  force_variance_ =
      std::visit([s](auto& rule) { return rule.Variance(s); }, rule_);
}

Eigen::Vector3d AttitudeFilter::WithoutBias(const BiasedForce& force) const {
  return force.col(0) - force.rightCols<3>() * b_a_;
}

RowVector AttitudeFilter::UseAccelerometer() {
  const double R =
      force_variance_ * Inflation(options_.accel_correlation_time, dt_, 1);
  verdict_.accel_variance = R;
  if (!std::isfinite(R)) return {};
  const double g = options_.place.gravity;
  const BiasedForce force_n = (q_ni_.toRotationMatrix() * C_if_) * force_;
  const Eigen::Vector3d residual = WithoutBias(force_n) - ForceAtRest_n(g);
  const Eigen::Matrix3d H = ForceAtRestByPsi_n(g);
  RowVector innovation(2);
  for (int row = 0; row < 2; ++row) {
    Vector h = Vector::Zero();
    h.head<3>() = H.row(row);
    h.segment<3>(AttitudeState::kAccelBias) =
        force_n.rightCols<3>().row(row).transpose();
    innovation(row) = UpdateState(h, residual(row), R);
  }
  return innovation;
}

void AttitudeFilter::LeaveAccelerometer() {
  verdict_.accel_variance = std::numeric_limits<double>::infinity();
}

RowVector AttitudeFilter::UseVelocityChange(const VelocityChange& change,
                                            const Eigen::Matrix3d& C_nb) {
  const Eigen::Vector3d u_n = C_nb * change.u_b;
  const Eigen::LLT<Eigen::Matrix3d> llt(change.R_n + C_nb * change.noise_b *
                                                         C_nb.transpose());
  Eigen::Matrix<double, 3, AttitudeState::kDim> H;
  H << -Skew(u_n), C_nb * change.by_gyro, C_nb * change.by_accel_bias,
      Eigen::Vector3d::Zero();
  const Eigen::Vector3d residual = llt.matrixL().solve(change.m_n - u_n);
  H = llt.matrixL().solve(H).eval();
  RowVector innovation(3);
  for (int row = 0; row < 3; ++row) {
    innovation(row) = UpdateState(H.row(row).transpose(), residual(row), 1.0);
  }
  return innovation;
}

void AttitudeFilter::AddField(const MagneticSample& reading) {
  field_.sum_i += reading.weight * (C_ib_ * reading.field_b);
  field_.weight += reading.weight;
  ++field_.count;
  field_.t = reading.t;
}

Eigen::Vector3d AttitudeFilter::ExpectedField() const {
  MagneticSurroundings magnetic = options_.magnetic;
  const double norm = reference_.is_known()
                          ? reference_.norm()
                          : std::hypot(magnetic.horizontal, magnetic.down);
  magnetic.horizontal = norm * std::cos(dip_);
  magnetic.down = norm * std::sin(dip_);
  return UndisturbedField(magnetic, magnetic.declination);
}

RowVector AttitudeFilter::UseMagnetometer() {
  verdict_.magnetic_used = false;
  verdict_.magnetic_disturbed = false;
  if (field_.count == 0) return {};
  const FieldMean field = field_;
  field_ = FieldMean();
  const double dt = field.t - field_t_;
  field_t_ = field.t;
  verdict_.magnetic_disturbed = field.weight <= 0.0;
  if (verdict_.magnetic_disturbed) return {};
  const Eigen::Vector3d u_n = q_ni_ * (field.sum_i / field.weight);
  const double norm = u_n.norm();
  const double dip = std::atan2(u_n.z(), u_n.head<2>().norm());
  const double rate = predicted_.dt > 0.0 ? predicted_.angle / dt_ : 0.0;
  verdict_.magnetic_disturbed = !reference_.Accept(dt, norm, dip, rate);
  if (verdict_.magnetic_disturbed) return {};
  verdict_.magnetic_used = true;
  const double R =
      options_.magnetic_sigma * options_.magnetic_sigma * field.count /
      field.weight *
      Inflation(options_.magnetic_correlation_time, dt, field.count);
  if (options_.magnetic_form == MagneticField::Form::kVector) {
    const Eigen::Vector3d m_n = ExpectedField();
    const Eigen::Matrix3d H = Skew(m_n);
    const double declination = options_.magnetic.declination;
    const double horizontal = m_n.head<2>().norm();
    const Eigen::Vector3d by_dip(-m_n.z() * std::cos(declination),
                                 -m_n.z() * std::sin(declination), horizontal);
    const Eigen::Vector3d residual = u_n - m_n;
    RowVector innovation(3);
    for (int row = 0; row < 3; ++row) {
      Vector h = Vector::Zero();
      h.head<3>() = H.row(row);
      h(AttitudeState::kDip) = by_dip(row);
      innovation(row) = UpdateState(h, residual(row), R);
    }
    return innovation;
  }
  const double R_azimuth = R / HorizontalSquare(u_n);
  const double azimuth = std::atan2(u_n.y(), u_n.x());
  const double residual =
      std::remainder(options_.magnetic.declination - azimuth, 2.0 * kPi);
  RowVector innovation(1);
  if (options_.decouple_heading && record_ != nullptr) {
    innovation(0) = UpdateComponent(2, 1.0, residual, R_azimuth);
  } else if (options_.decouple_heading) {
    // By the reading its noise would be in h, and pass for knowledge of the tilt.
    innovation(0) =
        ConsiderTilt(AzimuthByPsi(ExpectedField()), residual, R_azimuth);
  } else {
    innovation(0) = UpdateAttitude(AzimuthByPsi(u_n), residual, R_azimuth);
  }
  return innovation;
}

bool AttitudeFilter::ExplainsAsBias(const Eigen::Vector3d& w) const {
  constexpr double kSigmas = 3.0;
  const Eigen::Vector3d earth_b =
      (q_ni_ * q_ib_).conjugate() * options_.place.w_ie_n;
  const Eigen::Vector3d sigma =
      (P_.diagonal().segment<3>(AttitudeState::kGyroBias).array() +
       rate_sigma_ * rate_sigma_)
          .sqrt();
  return ((w - earth_b - b_g_).cwiseAbs().array() < kSigmas * sigma.array())
      .all();
}

void AttitudeFilter::UseRest() {
  if (predicted_.resting == 0) return;
  const Eigen::Vector3d w = predicted_.rest_w / predicted_.resting;
  const Eigen::Vector3d earth_b =
      (q_ni_ * q_ib_).conjugate() * options_.place.w_ie_n;
  const double R =
      options_.rest_sigma * options_.rest_sigma / predicted_.resting;
  for (int i = 0; i < 3; ++i) {
    UpdateComponent(AttitudeState::kGyroBias + i, 1.0,
                    w(i) - earth_b(i) - b_g_(i), R);
  }
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
