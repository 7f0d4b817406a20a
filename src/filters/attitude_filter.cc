#include "filters/attitude_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/rotation_summary.h"

namespace hindsight {

AttitudePlace PlaceOnEarth(const Eigen::Vector3d& p_e) {
  return {p_e, Gravity(p_e).norm(), NedAxes(p_e).transpose() * EarthRate_e()};
}

ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start) {
  ErrorLayout layout;
  Block attitude;
  attitude.key = {BlockKind::kAttitude};
  attitude.name = "attitude";
  attitude.unit = "rad";
  attitude.evolution = Evolution::Navigation();
  attitude.sigma0 = start.P.diagonal().head<3>().cwiseSqrt();
  layout.Add(attitude);
  Block bias;
  bias.key = {BlockKind::kGyroBias};
  bias.name = "gyro_bias";
  bias.unit = "rad/s";
  bias.evolution = noise.GyroBiasEvolution();
  bias.sigma0 = start.P.diagonal().tail<3>().cwiseSqrt();
  layout.Add(bias);
  return layout;
}

namespace {

/// How many samples dt apart share one error that goes on for `time`.
double Inflation(double time, double dt) {
  return time > dt && dt > 0.0 ? time / dt : 1.0;
}

}  // namespace

AttitudeFilter::AttitudeFilter(const AttitudeFilterOptions& options,
                               const ImuNoise& noise,
                               const AttitudeState& start,
                               double sample_interval)
    : options_(options),
      noise_(noise),
      rule_(MakeAccelerometerRule(options.rule)),
      reference_(options.reference),
      q_ni_(start.q_nb),
      q_ib_(Eigen::Quaterniond::Identity()),
      C_nb_(start.q_nb.toRotationMatrix()),
      dt_(sample_interval),
      t_(start.t),
      b_g_(start.b_g),
      P_(start.P) {
  if (options.low_pass_tau > 0.0) {
    low_pass_.emplace(options.low_pass_tau, sample_interval);
  }
}

void AttitudeFilter::Predict(double dt, const Eigen::Vector3d& w0,
                             const Eigen::Vector3d& w1) {
  const RotationSummary summary = SummarizeRotation(noise_, dt, w0, w1, b_g_);
  rate_ = summary.phi.norm() / dt;
  const Eigen::Matrix3d C_before = C_nb_;
  q_ib_ = q_ib_ * Exp(summary.phi);
  q_ib_.coeffs() *= 1.5 - 0.5 * q_ib_.squaredNorm();
  if (!options_.place.w_ie_n.isZero(0.0)) {
    q_ni_ = Exp(-dt * options_.place.w_ie_n) * q_ni_;
  }
  C_nb_ = (q_ni_ * q_ib_).toRotationMatrix();
  A_ = (-0.5 * dt) * (C_before + C_nb_);
  const double phi = noise_.GyroBiasEvolution().Phi(dt);
  q_attitude_ = summary.variance;
  q_bias_ = noise_.GyroBiasEvolution().Q(dt);

  const Eigen::Matrix3d P_bb = P_.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d P_ab = P_.topRightCorner<3, 3>();
  const Eigen::Matrix3d AP_bb = A_ * P_bb;
  const Eigen::Matrix3d AP_ba = A_ * P_ab.transpose();
  P_.topLeftCorner<3, 3>() +=
      AP_ba + AP_ba.transpose() + AP_bb * A_.transpose();
  P_.topRightCorner<3, 3>() = phi * (P_ab + AP_bb);
  P_.bottomLeftCorner<3, 3>() = P_.topRightCorner<3, 3>().transpose();
  P_.bottomRightCorner<3, 3>() = (phi * phi) * P_bb;
  P_.diagonal().head<3>().array() += q_attitude_;
  P_.diagonal().tail<3>().array() += q_bias_;
  b_g_ *= phi;
  t_ += dt;
  dt_ = dt;
}

void AttitudeFilter::FillTransition(Transition* out) const {
  out->Phi.setIdentity(6, 6);
  out->Phi.topRightCorner<3, 3>() = A_;
  out->Q.setZero(6, 6);
  out->Q.diagonal().head<3>().setConstant(q_attitude_);
  out->Q.diagonal().tail<3>().setConstant(q_bias_);
}

void AttitudeFilter::ApplyGain(const Vector6& PHt, double S,
                               double innovation) {
  const Vector6 K = PHt / S;
  dx_ += innovation * K;
  P_.noalias() -= K * PHt.transpose();
}

void AttitudeFilter::UpdateComponent(int i, double h, double residual,
                                     double R) {
  const Vector6 PHt = h * P_.col(i);
  ApplyGain(PHt, h * PHt(i) + R, residual - h * dx_(i));
}

void AttitudeFilter::UpdateAttitude(const Eigen::Vector3d& h, double residual,
                                    double R) {
  const Vector6 PHt = P_.leftCols<3>() * h;
  ApplyGain(PHt, h.dot(PHt.head<3>()) + R, residual - h.dot(dx_.head<3>()));
}

void AttitudeFilter::UseAccelerometer(const Eigen::Vector3d& f_b) {
  const double g = options_.place.gravity;
  Eigen::Vector3d f_n;
  double norm = 0.0;
  if (low_pass_) {
    const Eigen::Vector3d& f_i = low_pass_->Filter(q_ib_ * f_b);
    f_n = q_ni_ * f_i;
    norm = f_i.norm();
  } else {
    f_n = C_nb_ * f_b;
    norm = f_b.norm();
  }
  const double s = std::abs(norm - g);
  const double R =
      std::visit([s](auto& rule) { return rule.Variance(s); }, rule_) *
      Inflation(options_.accel_correlation_time, dt_);
  epoch_.accel_variance = R;
  if (!std::isfinite(R)) return;
  UpdateComponent(1, g, f_n.x(), R);
  UpdateComponent(0, -g, f_n.y(), R);
}

void AttitudeFilter::UseMagnetometer(double dt, const Eigen::Vector3d& field_b,
                                     double weight) {
  const Eigen::Vector3d u_n = C_nb_ * field_b;
  const double norm = u_n.norm();
  const double dip = std::atan2(u_n.z(), u_n.head<2>().norm());
  epoch_.magnetic_disturbed =
      !reference_.Accept(dt, norm, dip, rate_) || weight <= 0.0;
  if (epoch_.magnetic_disturbed) return;
  epoch_.magnetic_used = true;
  const double R = options_.magnetic_sigma * options_.magnetic_sigma / weight *
                   Inflation(options_.magnetic_correlation_time, dt);
  MagneticSurroundings magnetic = options_.magnetic;
  if (reference_.is_known()) {
    magnetic.horizontal = reference_.norm() * std::cos(reference_.dip());
    magnetic.down = reference_.norm() * std::sin(reference_.dip());
  }
  const Eigen::Vector3d m_n = UndisturbedField(magnetic, magnetic.declination);
  if (options_.magnetic_form == MagneticField::Form::kVector) {
    const Eigen::Matrix3d H = Skew(m_n);
    const Eigen::Vector3d residual = u_n - m_n;
    for (int row = 0; row < 3; ++row) {
      UpdateAttitude(H.row(row), residual(row), R);
    }
    return;
  }
  const double h2 = std::max(u_n.head<2>().squaredNorm(), 0.01);
  const double azimuth = std::atan2(u_n.y(), u_n.x());
  const double residual =
      std::remainder(magnetic.declination - azimuth, 2.0 * kPi);
  if (options_.decouple_heading) {
    UpdateComponent(2, 1.0, residual, R / h2);
  } else {
    UpdateAttitude({-u_n.z() * u_n.x() / h2, -u_n.z() * u_n.y() / h2, 1.0},
                   residual, R / h2);
  }
}

void AttitudeFilter::UseRest(double dt, const Eigen::Vector3d& w,
                             const Eigen::Vector3d& f) {
  constexpr double kSmoothing = 0.5;  // [s]
  if (!rest_started_) {
    rest_w_ = w;
    rest_f_ = f;
    rest_started_ = true;
  }
  const double gain = std::min(dt / kSmoothing, 1.0);
  rest_w_ += gain * (w - rest_w_);
  rest_f_ += gain * (f - rest_f_);
  const bool still =
      (w - rest_w_).squaredNorm() < options_.rest_rate * options_.rest_rate &&
      (f - rest_f_).squaredNorm() < options_.rest_force * options_.rest_force &&
      rest_w_.squaredNorm() < options_.rest_rate * options_.rest_rate;
  rest_for_ = still ? rest_for_ + dt : 0.0;
  if (rest_for_ < options_.rest_time) return;
  const Eigen::Vector3d earth_b = C_nb_.transpose() * options_.place.w_ie_n;
  const double R = options_.rest_sigma * options_.rest_sigma;
  for (int i = 0; i < 3; ++i) {
    UpdateComponent(3 + i, 1.0, rest_w_(i) - earth_b(i) - b_g_(i), R);
  }
}

void AttitudeFilter::Reset() {
  q_ni_ = Exp(dx_.head<3>()) * q_ni_;
  q_ni_.coeffs() *= 1.5 - 0.5 * q_ni_.squaredNorm();
  C_nb_ = (q_ni_ * q_ib_).toRotationMatrix();
  b_g_ += dx_.tail<3>();
  dx_.setZero();
  epoch_ = {};
}

AttitudeState AttitudeFilter::state() const {
  return {t_, q_ni_ * q_ib_, b_g_, P_};
}

namespace {

State StateOf(const AttitudePlace& place, const Eigen::Quaterniond& q_en,
              const AttitudeState& a) {
  State x;
  x.t = a.t;
  x.p_e = place.p_e;
  x.q_eb = (q_en * a.q_nb).normalized();
  x.b_g = a.b_g;
  return x;
}

}  // namespace

AttitudeRun RunAttitudeFilter(const ImuStream& imu,
                              std::span<const MagneticSample> magnetic,
                              const AttitudeFilterOptions& options,
                              const AttitudeState& start, LinearTape* tape,
                              const std::function<void(std::size_t)>& poll) {
  constexpr std::size_t kPollEvery = 8192;
  const Eigen::Quaterniond q_en(NedAxes(options.place.p_e));
  AttitudeFilter filter(options, imu.noise, start, MedianInterval(imu));
  AttitudeRun run;
  run.epochs.resize(imu.samples.size());
  if (tape != nullptr) {
    tape->Reserve(imu.samples.size());
    tape->NeglectTransport();
  }
  Transition transition;
  transition.c = ErrorVector::Zero(6);
  std::size_t next = 0;
  double magnetic_t = start.t;
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    const ImuSample& sample = imu.samples[k];
    if (k > 0) {
      const ImuSample& before = imu.samples[k - 1];
      filter.Predict(sample.t - before.t, before.gyro, sample.gyro);
    }
    TapeEpoch epoch;
    Eigen::Matrix<double, 6, 6> P_minus;
    if (tape != nullptr) {
      epoch.t = sample.t;
      epoch.x_minus = StateOf(options.place, q_en, filter.state());
      P_minus = filter.P();
      filter.FillTransition(&transition);
    }
    filter.UseAccelerometer(sample.accel);
    for (; next < magnetic.size() && magnetic[next].t <= sample.t; ++next) {
      const double age = sample.t - magnetic[next].t;
      const Eigen::Vector3d turn = age * (sample.gyro - filter.state().b_g);
      filter.UseMagnetometer(magnetic[next].t - magnetic_t,
                             Exp(-turn) * magnetic[next].field_b,
                             magnetic[next].weight);
      magnetic_t = magnetic[next].t;
    }
    if (options.rest_sigma > 0.0 && k > 0) {
      filter.UseRest(sample.t - imu.samples[k - 1].t, sample.gyro,
                     sample.accel);
    }
    AttitudeEpoch& out = run.epochs[k];
    out = filter.epoch();
    if (tape != nullptr) {
      epoch.dx_minus = ErrorVector::Zero(6);
      epoch.c = epoch.dx_minus;
      epoch.dx_plus = filter.dx();
    }
    filter.Reset();
    out.x = filter.state();
    if (tape != nullptr) {
      epoch.reset = true;
      epoch.x_plus = StateOf(options.place, q_en, out.x);
      tape->Append(std::move(epoch), transition, P_minus, out.x.P);
    }
    if (k % kPollEvery == 0) {
      if (!out.x.P.allFinite() || !out.x.q_nb.coeffs().allFinite()) {
        throw EstimationError("attitude filter diverged at t = " +
                              std::to_string(sample.t) + " s");
      }
      if (poll) poll(k + 1);
    }
  }
  return run;
}

}  // namespace hindsight
