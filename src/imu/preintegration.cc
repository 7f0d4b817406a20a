#include "imu/preintegration.h"

#include <algorithm>
#include <cmath>

#include "geometry/so3.h"
#include "imu/imu_noise.h"
#include "imu/pair.h"

namespace hindsight {

namespace {

/// A function of one number of both.
template <typename Function>
double Each(const Function& f, double x) {
  return f(x);
}
template <typename Function>
Pair Each(const Function& f, const Pair& x) {
  return {f(x[0]), f(x[1])};
}

double LaneOf(double x, int) { return x; }
double LaneOf(const Pair& x, int lane) { return x[lane]; }
template <typename Derived>
auto LaneOf(const Eigen::MatrixBase<Derived>& m, int lane) {
  return m
      .unaryExpr(
          [lane](const typename Derived::Scalar& x) { return LaneOf(x, lane); })
      .eval();
}

Eigen::Quaterniond ExpOf(const Eigen::Vector3d& v) { return Exp(v); }
Eigen::Quaternion<Pair> ExpOf(const Eigen::Matrix<Pair, 3, 1>& v) {
  const Pair angle2 = v.squaredNorm();
  if (angle2[0] < kSmallAngle2 && angle2[1] < kSmallAngle2) {
    return SmallExp<Pair>(v);
  }
  const Eigen::Quaterniond a = Exp(LaneOf(v, 0));
  const Eigen::Quaterniond b = Exp(LaneOf(v, 1));
  return {{a.w(), b.w()}, {a.x(), b.x()}, {a.y(), b.y()}, {a.z(), b.z()}};
}

/// [v x] M.
template <typename Real>
Eigen::Matrix<Real, 3, 3> CrossColumns(const Eigen::Matrix<Real, 3, 1>& v,
                                       const Eigen::Matrix<Real, 3, 3>& M) {
  Eigen::Matrix<Real, 3, 3> out;
  for (int j = 0; j < 3; ++j) out.col(j) = v.cross(M.col(j));
  return out;
}

}  // namespace

template <typename Real>
LinearRatesOf<Real> Calibrated(const LinearRatesOf<Real>& raw,
                               const ImuCalibration& calibration) {
  const Eigen::Matrix<Real, 3, 1> b_g = calibration.b_g.cast<Real>();
  const Eigen::Matrix<Real, 3, 1> b_a = calibration.b_a.cast<Real>();
  LinearRatesOf<Real> r = {raw.dt, raw.w0 - b_g, raw.w1 - b_g, raw.f0 - b_a,
                           raw.f1 - b_a};
  if (!calibration.s_g.isZero(0.0)) {
    const Eigen::Array3d one = 1.0 / (1.0 + calibration.s_g.array());
    const Eigen::Array<Real, 3, 1>& factor = one.cast<Real>();
    r.w0.array() *= factor;
    r.w1.array() *= factor;
  }
  if (!calibration.s_a.isZero(0.0)) {
    const Eigen::Array3d one = 1.0 / (1.0 + calibration.s_a.array());
    const Eigen::Array<Real, 3, 1>& factor = one.cast<Real>();
    r.f0.array() *= factor;
    r.f1.array() *= factor;
  }
  return r;
}

template LinearRates Calibrated(const LinearRates&, const ImuCalibration&);

template <typename Real>
PreintegratorOf<Real>::PreintegratorOf(const ImuNoise& noise,
                                       bool with_scale_jacobians)
    : noise_(noise),
      with_scale_(with_scale_jacobians),
      has_bias_noise_(noise.gyro_bias_walk > 0.0 ||
                      noise.accel_bias_walk > 0.0),
      gauss_markov_(std::isfinite(noise.gyro_bias_tau) ||
                    std::isfinite(noise.accel_bias_tau)) {}

template <typename Real>
void PreintegratorOf<Real>::Start(const Real& t_i,
                                  const ImuCalibration& calibration) {
  calibration_ = calibration;
  t_i_ = t_i;
  T_ = 0.0;
  q_.setIdentity();
  C_.setIdentity();
  v_.setZero();
  p_.setZero();
  for (Matrix3* m : {&S_g_, &V_g_, &P_g_, &S_a_, &P_a_, &U_g_, &VU_g_, &PU_g_,
                     &U_a_, &PU_a_, &qvv_, &qvu_, &quu_}) {
    m->setZero();
  }
  q_sum_ = 0.0;
  a_sum_ = as_ = ass_ = 0.0;
  qv_.setZero();
  qu_.setZero();
  snapshot_count_ = 0;
  snapshot_every_ = 1;
  samples_since_snapshot_ = 0;
  if (has_bias_noise_) TakeSnapshot();
}

template <typename Real>
void PreintegratorOf<Real>::TakeSnapshot() {
  if (snapshot_count_ == kMaxSnapshots) {
    // Keep every other one, so that any number of samples fits.
    for (int k = 1; 2 * k < kMaxSnapshots; ++k) {
      snapshots_[static_cast<std::size_t>(k)] =
          snapshots_[static_cast<std::size_t>(2 * k)];
    }
    snapshot_count_ /= 2;
    snapshot_every_ *= 2;
  }
  snapshots_[static_cast<std::size_t>(snapshot_count_++)] = {
      T_, v_, p_, S_g_, V_g_, P_g_, S_a_, P_a_};
}

template <typename Real>
void PreintegratorOf<Real>::Add(const LinearRatesOf<Real>& raw,
                                const IntervalNoise& extra) {
  using std::exp;
  const LinearRatesOf<Real> r = Calibrated(raw, calibration_);
  const Real dt = r.dt;
  const SampleIntegralOf<Real> sample = Integrate(r);

  const Vector3 dv_i = C_ * sample.dv;
  const Vector3 p_next = p_ + dt * v_ + C_ * sample.dp;
  const Vector3 v_next = v_ + dv_i;
  q_ = q_ * ExpOf(sample.phi);
  const Matrix3 C_next = q_.toRotationMatrix();

  // Gyro noise moments at the middle of the sample.
  const Vector3 v_mid = 0.5 * (v_ + v_next);
  const Vector3 u_mid = 0.5 * (p_ + p_next) - (T_ + 0.5 * dt) * v_mid;
  const Real squared_rate = 0.25 * (r.w0 + r.w1).squaredNorm();
  const Real q_dt =
      dt * Each(
               [&](double squared) {
                 return GyroWhiteNoise(noise_, squared) + extra.gyro;
               },
               squared_rate);
  const Real a_dt = (AccelWhiteNoise(noise_) + extra.accel) * dt;
  const Real s_mid = T_ + 0.5 * dt;
  a_sum_ += a_dt;
  as_ += a_dt * s_mid;
  ass_ += a_dt * (s_mid * s_mid + (1.0 / 12.0) * dt * dt);
  q_sum_ += q_dt;
  const Vector3 qv = q_dt * v_mid;
  const Vector3 qu = q_dt * u_mid;
  qv_ += qv;
  qu_ += qu;
  qvv_.noalias() += qv * v_mid.transpose();
  qvu_.noalias() += qv * u_mid.transpose();
  quu_.noalias() += qu * u_mid.transpose();

  // Bias sensitivities, trapezoidal in the attitude.
  const Matrix3 C_mid_dt = (0.5 * dt) * (C_ + C_next);
  if (with_scale_) AddScaleJacobians(C_mid_dt, r, dv_i);
  Matrix3 dS_g = C_mid_dt;
  if (gauss_markov_) {
    const Real decay_g = exp(-(T_ + 0.5 * dt) / noise_.gyro_bias_tau);
    dS_g *= decay_g;
  }
  const Matrix3 dV_g = CrossColumns<Real>(dv_i, S_g_ + 0.5 * dS_g);
  P_g_ += dt * (V_g_ + 0.5 * dV_g);
  V_g_ += dV_g;
  S_g_ += dS_g;
  if (gauss_markov_) {
    const Real decay_a = exp(-(T_ + 0.5 * dt) / noise_.accel_bias_tau);
    P_a_ += dt * (S_a_ + (0.5 * decay_a) * C_mid_dt);
    S_a_ += decay_a * C_mid_dt;
  } else {
    P_a_ += dt * (S_a_ + 0.5 * C_mid_dt);
    S_a_ = S_g_;
  }

  v_ = v_next;
  p_ = p_next;
  C_ = C_next;
  T_ += dt;
  if (has_bias_noise_ && ++samples_since_snapshot_ >= snapshot_every_) {
    samples_since_snapshot_ = 0;
    TakeSnapshot();
  }
}

template <typename Real>
void PreintegratorOf<Real>::AddScaleJacobians(const Matrix3& C_mid_dt,
                                              const LinearRatesOf<Real>& r,
                                              const Vector3& dv_i) {
  const Matrix3 dU_g = C_mid_dt * (0.5 * (r.w0 + r.w1)).asDiagonal();
  const Matrix3 dVU_g = CrossColumns<Real>(dv_i, U_g_ + 0.5 * dU_g);
  PU_g_ += r.dt * (VU_g_ + 0.5 * dVU_g);
  VU_g_ += dVU_g;
  U_g_ += dU_g;
  const Matrix3 dU_a = C_mid_dt * (0.5 * (r.f0 + r.f1)).asDiagonal();
  PU_a_ += r.dt * (U_a_ + 0.5 * dU_a);
  U_a_ += dU_a;
}

/// What the interval `lane` of a pair has come to.
template <typename Real>
PreintegratorOf<double> PreintegratorOf<Real>::Lane(int lane) const {
  PreintegratorOf<double> out(noise_, with_scale_);
  const auto take = [lane](const auto& from, auto* to) {
    *to = LaneOf(from, lane);
  };
  out.calibration_ = calibration_;
  take(t_i_, &out.t_i_);
  take(T_, &out.T_);
  take(q_.coeffs(), &out.q_.coeffs());
  take(v_, &out.v_);
  take(p_, &out.p_);
  take(S_g_, &out.S_g_);
  take(V_g_, &out.V_g_);
  take(P_g_, &out.P_g_);
  take(S_a_, &out.S_a_);
  take(P_a_, &out.P_a_);
  take(U_g_, &out.U_g_);
  take(VU_g_, &out.VU_g_);
  take(PU_g_, &out.PU_g_);
  take(U_a_, &out.U_a_);
  take(PU_a_, &out.PU_a_);
  take(q_sum_, &out.q_sum_);
  take(a_sum_, &out.a_sum_);
  take(as_, &out.as_);
  take(ass_, &out.ass_);
  take(qv_, &out.qv_);
  take(qu_, &out.qu_);
  take(qvv_, &out.qvv_);
  take(qvu_, &out.qvu_);
  take(quu_, &out.quu_);
  out.snapshot_count_ = snapshot_count_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(snapshot_count_); ++k) {
    const Snapshot& x = snapshots_[k];
    out.snapshots_[k] = {LaneOf(x.s, lane),   LaneOf(x.v, lane),
                         LaneOf(x.p, lane),   LaneOf(x.S_g, lane),
                         LaneOf(x.V_g, lane), LaneOf(x.P_g, lane),
                         LaneOf(x.S_a, lane), LaneOf(x.P_a, lane)};
  }
  return out;
}

template <typename Real>
ImuSummary PreintegratorOf<Real>::Finish(int lane) const {
  return Lane(lane).Summary();
}

template class PreintegratorOf<double>;
// Of pairs all but the summary, which is made of one of them.
template PreintegratorOf<Pair>::PreintegratorOf(const ImuNoise&, bool);
template void PreintegratorOf<Pair>::Start(const Pair&, const ImuCalibration&);
template void PreintegratorOf<Pair>::Add(const LinearRatesOf<Pair>&,
                                         const IntervalNoise&);
template ImuSummary PreintegratorOf<Pair>::Finish(int) const;

}  // namespace hindsight
