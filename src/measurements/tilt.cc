#include "measurements/tilt.h"

#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

Eigen::Vector3d ForceAtRest_n(double gravity) { return {0.0, 0.0, -gravity}; }

Eigen::Matrix3d ForceAtRestByPsi_n(double gravity) {
  return Skew(ForceAtRest_n(gravity));
}

void Tilt::Evaluate(const ModelContext& context,
                    LinearizedMeasurement* out) const {
  const State& x = context.state;
  const ErrorLayout& layout = context.layout;
  const ImuCalibration calibration = CalibrationOf(layout, x);
  const Eigen::Matrix3d C_bn =
      (x.q_eb.conjugate() * Eigen::Quaterniond(x.C_en())).toRotationMatrix();
  const Eigen::Vector3d force_b = C_bn * ForceAtRest_n(gravity);
  const Eigen::Vector3d factor = 1.0 + calibration.s_a.array();
  const Eigen::Matrix3d by_psi =
      factor.asDiagonal() * C_bn * ForceAtRestByPsi_n(gravity);
  out->Resize(rows(), layout.dim());
  out->residual = f_b - factor.cwiseProduct(force_b) - calibration.b_a;
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor, by_psi, &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    -by_psi * NedTurn(x.p_e), &out->H);
  layout.AddColumns(BlockKind::kAccelBias, BlockKey::kNoSensor,
                    Eigen::Matrix3d::Identity(), &out->H);
  layout.AddColumns(BlockKind::kAccelScale, BlockKey::kNoSensor,
                    Eigen::Matrix3d(force_b.asDiagonal()), &out->H);
  out->R.diagonal().setConstant(sigma * sigma);
}

const SensorKind& TiltKind() {
  static const SensorKind kKind = {
      .name = "tilt",
      .help = "an accelerometer that shows which way is down",
      .configured = false,
      .residual_unit = "m/s^2",
      .has_clock = false,
      .prepare = [](SensorSettings* s) { s->pattern = Tilt(); },
  };
  return kKind;
}

}  // namespace hindsight
