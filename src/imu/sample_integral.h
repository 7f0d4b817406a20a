#ifndef HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_
#define HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_

#include <Eigen/Core>

namespace hindsight {

/// Angular rate and specific force over one sample interval, linear in time
/// from index 0 at its start to index 1 at its end; body axes, SI.
struct LinearRates {
  double dt = 0.0;
  Eigen::Vector3d w0, w1;  ///< [rad/s]
  Eigen::Vector3d f0, f1;  ///< [m/s^2]
};

/// Integrals of a LinearRates over its interval, resolved in the body axes at
/// its start.
struct SampleIntegral {
  Eigen::Vector3d phi;  ///< rotation vector, with coning [rad]
  Eigen::Vector3d dv;   ///< velocity increment, with rotation and sculling
  Eigen::Vector3d dp;   ///< its integral [m]
};

/// phi = dt (w0 + w1)/2 + dt^2/12 w0 x w1,
/// dv  = int (f + alpha x f + alpha x (alpha x f)/2),  alpha = int w,
/// dp  = int int of the same. Exact for the linear profile to second order in
/// the rotation of one sample (third for its constant part): Savage, Strapdown
/// Analytics, 7.1 and 7.2; with the profile through this and the previous
/// increment these are the two-sample coning and sculling algorithms.
inline SampleIntegral Integrate(const LinearRates& s) {
  const double T = s.dt;
  const double T2 = T * T;
  const Eigen::Vector3d dw = s.w1 - s.w0;
  const Eigen::Vector3d df = s.f1 - s.f0;
  const Eigen::Vector3d w = 0.5 * (s.w0 + s.w1);
  const Eigen::Vector3d f = 0.5 * (s.f0 + s.f1);
  const Eigen::Vector3d w0f0 = s.w0.cross(s.f0);
  const Eigen::Vector3d w0df = s.w0.cross(df);
  const Eigen::Vector3d dwf0 = dw.cross(s.f0);
  const Eigen::Vector3d dwdf = dw.cross(df);
  const Eigen::Vector3d wwf = w.cross(w.cross(f));
  SampleIntegral out;
  out.phi = T * w + (T2 / 12.0) * s.w0.cross(s.w1);
  out.dv = T * f + T2 * (0.5 * w0f0 + w0df / 3.0 + dwf0 / 6.0 + dwdf / 8.0) +
           (T2 * T / 6.0) * wwf;
  out.dp = T2 * (0.5 * s.f0 + df / 6.0) +
           T2 * T * (w0f0 / 6.0 + w0df / 12.0 + dwf0 / 24.0 + dwdf / 40.0) +
           (T2 * T2 / 24.0) * wwf;
  return out;
}

/// The linear profile whose mean over this sample is `increment` / dt and whose
/// slope is that from the previous sample's mean to this one's.
inline LinearRates RatesFromIncrements(double dt_previous,
                                       const Eigen::Vector3d& dtheta_previous,
                                       const Eigen::Vector3d& dvel_previous,
                                       double dt, const Eigen::Vector3d& dtheta,
                                       const Eigen::Vector3d& dvel) {
  const Eigen::Vector3d w = dtheta / dt;
  const Eigen::Vector3d f = dvel / dt;
  const double half_ratio = dt / (dt + dt_previous);
  const Eigen::Vector3d half_dw =
      half_ratio * (w - dtheta_previous / dt_previous);
  const Eigen::Vector3d half_df =
      half_ratio * (f - dvel_previous / dt_previous);
  return {dt, w - half_dw, w + half_dw, f - half_df, f + half_df};
}

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_SAMPLE_INTEGRAL_H_
