#include "measurements/stationary.h"

#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "measurements/point_motion.h"

namespace hindsight {

void ZeroVelocity::Evaluate(const ModelContext& context,
                            LinearizedMeasurement* out) const {
  const State& x = context.state;
  const Eigen::Vector3d v_n = x.v_n();
  out->Resize(rows(), context.layout.dim());
  out->residual = -v_n;
  context.layout.AddColumns(BlockKind::kVelocity, BlockKey::kNoSensor,
                            Eigen::Matrix3d::Identity(), &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            Skew(v_n) * NedTurn(x.p_e), &out->H);
  out->R.diagonal().setConstant(sigma * sigma);
}

void ZeroAngularRate::Evaluate(const ModelContext& context,
                               LinearizedMeasurement* out) const {
  const State& x = context.state;
  const ErrorLayout& layout = context.layout;
  const ImuCalibration calibration = CalibrationOf(layout, x);
  const Eigen::Matrix3d C_be = x.q_eb.conjugate().toRotationMatrix();
  const Eigen::Vector3d earth_b = C_be * EarthRate_e();
  const Eigen::Vector3d factor = 1.0 + calibration.s_g.array();
  out->Resize(rows(), layout.dim());
  out->residual = w_ib_b - factor.cwiseProduct(earth_b) - x.b_g;
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor,
                    factor.asDiagonal() * C_be * Skew(EarthRate_e()) * x.C_en(),
                    &out->H);
  layout.AddColumns(BlockKind::kGyroBias, BlockKey::kNoSensor,
                    Eigen::Matrix3d::Identity(), &out->H);
  layout.AddColumns(BlockKind::kGyroScale, BlockKey::kNoSensor,
                    Eigen::Matrix3d(earth_b.asDiagonal()), &out->H);
  out->R.diagonal().setConstant(sigma * sigma);
}

}  // namespace hindsight
