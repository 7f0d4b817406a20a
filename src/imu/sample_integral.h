#ifndef HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_
#define HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_

#include <Eigen/Core>

namespace hindsight {

/// Angular rate and specific force over one sample interval, linear in time
/// from index 0 at its start to index 1 at its end; body axes, SI.
template <typename Real>
struct LinearRatesOf {
  Real dt = 0.0;
  Eigen::Matrix<Real, 3, 1> w0, w1;  ///< [rad/s]
  Eigen::Matrix<Real, 3, 1> f0, f1;  ///< [m/s^2]
};
using LinearRates = LinearRatesOf<double>;

/// Integrals of LinearRates over their interval, resolved in the body axes at
/// its start.
template <typename Real>
struct SampleIntegralOf {
  Eigen::Matrix<Real, 3, 1> phi;  ///< rotation vector, with coning [rad]
  Eigen::Matrix<Real, 3, 1>
      dv;  ///< velocity increment, with rotation and sculling
  Eigen::Matrix<Real, 3, 1> dp;  ///< its integral [m]
};
using SampleIntegral = SampleIntegralOf<double>;

/// phi = dt (w0 + w1)/2 + dt^2/12 w0 x w1,
/// dv  = int (f + alpha x f + alpha x (alpha x f)/2),  alpha = int w,
/// dp  = int int of the same. Exact for the linear profile to second order in
/// the rotation of one sample (third for its constant part): Savage, Strapdown
/// Analytics, 7.1 and 7.2; with the profile through this and the previous
/// increment these are the two-sample coning and sculling algorithms.
template <typename Real>
SampleIntegralOf<Real> Integrate(const LinearRatesOf<Real>& s) {
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  const Real T = s.dt;
  const Real T2 = T * T;
  const Vector3 dw = s.w1 - s.w0;
  const Vector3 df = s.f1 - s.f0;
  const Vector3 w = 0.5 * (s.w0 + s.w1);
  const Vector3 f = 0.5 * (s.f0 + s.f1);
  const Vector3 w0f0 = s.w0.cross(s.f0);
  const Vector3 w0df = s.w0.cross(df);
  const Vector3 dwf0 = dw.cross(s.f0);
  const Vector3 dwdf = dw.cross(df);
  const Vector3 wwf = w.cross(w.cross(f));
  SampleIntegralOf<Real> out;
  out.phi = T * w + (T2 * (1.0 / 12.0)) * s.w0.cross(s.w1);
  // By products: a quotient takes a processor ten times as long.
  out.dv = T * f +
           T2 * (0.5 * w0f0 + (1.0 / 3.0) * w0df + (1.0 / 6.0) * dwf0 +
                 (1.0 / 8.0) * dwdf) +
           (T2 * T * (1.0 / 6.0)) * wwf;
  out.dp = T2 * (0.5 * s.f0 + (1.0 / 6.0) * df) +
           T2 * T *
               ((1.0 / 6.0) * w0f0 + (1.0 / 12.0) * w0df + (1.0 / 24.0) * dwf0 +
                (1.0 / 40.0) * dwdf) +
           (T2 * T2 * (1.0 / 24.0)) * wwf;
  return out;
}

/// The linear profile whose mean over this sample is `increment` / dt and whose
/// slope is that from the previous sample's mean to this one's.
inline LinearRates RatesFromIncrements(double dt_previous,
                                       const Eigen::Vector3d& dtheta_previous,
                                       const Eigen::Vector3d& dvel_previous,
                                       double dt, const Eigen::Vector3d& dtheta,
                                       const Eigen::Vector3d& dvel) {
  const double rate = 1.0 / dt;
  const double rate_previous = 1.0 / dt_previous;
  const Eigen::Vector3d w = rate * dtheta;
  const Eigen::Vector3d f = rate * dvel;
  const double half_ratio = dt / (dt + dt_previous);
  const Eigen::Vector3d half_dw =
      half_ratio * (w - rate_previous * dtheta_previous);
  const Eigen::Vector3d half_df =
      half_ratio * (f - rate_previous * dvel_previous);
  return {dt, w - half_dw, w + half_dw, f - half_df, f + half_df};
}

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_
