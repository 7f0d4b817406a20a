#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "attitude/attitude_filter.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/tilt.h"

namespace hindsight {
namespace {

/// Variance of the mean of `count` readings within dt, in that of one, if their
/// errors go on for `time`.
double Inflation(double time, double dt, int count) {
  return std::max(1.0 / count, dt > 0.0 ? time / dt : 0.0);
}

}  // namespace

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
  Vector full = Vector::Zero();
  full.head<3>() = h;
  return UpdateState(full, residual, R);
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
  verdict_.horizontal = reference_.norm() * std::cos(dip_);
  verdict_.down = reference_.norm() * std::sin(dip_);
  const double R =
      options_.magnetic_sigma * options_.magnetic_sigma * field.count /
      field.weight *
      Inflation(options_.magnetic_correlation_time, dt, field.count);
  return options_.magnetic_form == MagneticField::Form::kVector
             ? UseFieldVector(u_n, R)
             : UseAzimuth(u_n, R / HorizontalSquare(u_n));
}

RowVector AttitudeFilter::UseFieldVector(const Eigen::Vector3d& u_n, double R) {
  const Eigen::Vector3d m_n = ExpectedField();
  const Eigen::Matrix3d H = Skew(m_n);
  const double declination = options_.magnetic.declination;
  const Eigen::Vector3d by_dip(-m_n.z() * std::cos(declination),
                               -m_n.z() * std::sin(declination),
                               m_n.head<2>().norm());
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

RowVector AttitudeFilter::UseAzimuth(const Eigen::Vector3d& u_n, double R) {
  const double azimuth = std::atan2(u_n.y(), u_n.x());
  const double residual =
      std::remainder(options_.magnetic.declination - azimuth, 2.0 * kPi);
  RowVector innovation(1);
  if (options_.decouple_heading && record_ != nullptr) {
    innovation(0) = UpdateComponent(2, 1.0, residual, R);
  } else if (options_.decouple_heading) {
    // By the reading its noise would be in h, and pass for knowledge of the tilt.
    innovation(0) = ConsiderTilt(AzimuthByPsi(ExpectedField()), residual, R);
  } else {
    innovation(0) = UpdateAttitude(AzimuthByPsi(u_n), residual, R);
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

}  // namespace hindsight
