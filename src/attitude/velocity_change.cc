#include "attitude/velocity_change.h"

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/tilt.h"

namespace hindsight {
namespace {

/// w x l of a reading, and its change with the gyro's errors.
struct Swing {
  Eigen::Vector3d v_b;
  Eigen::Matrix<double, 3, 6> by_gyro;
};

Swing SwingOf(const VelocitySample& reading, const ImuCalibration& calibration,
              ImuIntegrator* integrator) {
  const Eigen::Vector3d w =
      (integrator->ReadingAt(reading.t).w_ib_b - calibration.b_g)
          .cwiseQuotient(Eigen::Vector3d::Ones() + calibration.s_g);
  const Eigen::Matrix3d l = Skew(reading.lever_arm_b);
  Swing swing;
  swing.v_b = w.cross(reading.lever_arm_b);
  swing.by_gyro << l, l * w.asDiagonal();
  return swing;
}

Eigen::Vector3d ExpectedChange(const VelocitySample& before,
                               const VelocitySample& after,
                               const AttitudePlace& place) {
  const Eigen::Vector3d v = 0.5 * (before.v_n + after.v_n);
  Eigen::Vector3d turning = 2.0 * place.w_ie_n;
  if (!turning.isZero(0.0)) {
    turning += TransportRate_n(GeodeticFromEcef(place.p_e), v);
  }
  return after.v_n - before.v_n +
         (after.t - before.t) *
             (turning.cross(v) + ForceAtRest_n(place.gravity));
}

}  // namespace

VelocityChange ChangeBetween(const VelocitySample& before,
                             const VelocitySample& after,
                             const AttitudePlace& place,
                             const ImuCalibration& calibration,
                             ImuIntegrator* integrator) {
  const Swing first = SwingOf(before, calibration, integrator);
  const ImuSummary summary =
      integrator->Summarize(before.t, after.t, calibration);
  const Swing last = SwingOf(after, calibration, integrator);
  const Eigen::Matrix3d C_ji = summary.dR.conjugate().toRotationMatrix();
  const Eigen::Vector3d y = summary.dv - first.v_b;
  Eigen::Matrix<double, 3, 6> R_gyro, v_gyro;
  R_gyro << summary.R_bg, summary.R_sg;
  v_gyro << summary.v_bg, summary.v_sg;
  VelocityChange change;
  change.u_b = C_ji * y + last.v_b;
  change.m_n = ExpectedChange(before, after, place);
  change.by_gyro =
      C_ji * (Skew(y) * R_gyro + v_gyro - first.by_gyro) + last.by_gyro;
  Eigen::Matrix<double, 3, 6> by_noise;  // of dv, and on the right of dR
  by_noise << C_ji, Skew(C_ji * y);
  change.by_accel_bias = C_ji * summary.v_ba;
  change.noise_b =
      by_noise * summary.noise.bottomRightCorner<6, 6>() * by_noise.transpose();
  change.R_n = before.R_n + after.R_n;
  return change;
}

}  // namespace hindsight
