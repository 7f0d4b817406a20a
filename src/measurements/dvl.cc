#include "measurements/dvl.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_axes.h"

namespace hindsight {

int Dvl::rows() const {
  return static_cast<int>(
      std::count(valid.begin(), valid.begin() + components(), true));
}

Eigen::Vector3d Dvl::Direction(int component) const {
  if (form == Form::kThreeAxis) return Eigen::Vector3d::Unit(component);
  const double azimuth = beam_azimuth + component * 0.5 * kPi;
  return {std::sin(beam_angle) * std::cos(azimuth),
          std::sin(beam_angle) * std::sin(azimuth), std::cos(beam_angle)};
}

void Dvl::Evaluate(const ModelContext& context,
                   LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const State& x = context.state;
  const int sensor = context.sensor_index;
  // Through the water the point moves with v - v_c; every sensitivity but that
  // to the current is then as over the ground.
  const Eigen::Vector3d v_c = water
                                  ? Parameter3(layout, x, BlockKind::kCurrent,
                                               sensor, Eigen::Vector3d::Zero())
                                  : Eigen::Vector3d::Zero();
  const PointMotion motion = MotionOfSensor(context);
  const SensorAxes axes = AxesOfSensor(context, motion);
  const Eigen::Vector3d u_e = motion.v_e - motion.C_en * v_c;
  const Eigen::Vector3d v_d = axes.C_se * u_e;
  const double k =
      Parameter1(layout, x, BlockKind::kScale, sensor, context.sensor.scale);

  out->Resize(rows(), layout.dim());
  RowTimes3 B(rows(), 3);
  for (int i = 0, row = 0; i < components(); ++i) {
    if (!valid[static_cast<std::size_t>(i)]) continue;
    B.row(row) = Direction(i).transpose();
    out->residual(row) = speed(i) - (1.0 + k) * B.row(row).dot(v_d);
    out->R(row, row) = sigma(i) * sigma(i);
    ++row;
  }
  const RowTimes3 A = (1.0 + k) * B;
  AddVelocityColumns(context, motion, A * axes.C_se, &out->H);
  AddAxesColumns(context, motion, axes, u_e, A, &out->H);
  layout.AddColumns(BlockKind::kScale, sensor, B * v_d, &out->H);
  if (!water) return;
  const RowTimes3 A_n = A * axes.C_se * motion.C_en;
  layout.AddColumns(BlockKind::kCurrent, sensor, -A_n, &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    A_n * Skew(v_c) * NedTurn(x.p_e), &out->H);
}

}  // namespace hindsight
