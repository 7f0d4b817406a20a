#include "measurements/dvl.h"

#include <cmath>
#include <cstddef>

#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_axes.h"

namespace hindsight {

int Dvl::rows() const {
  return static_cast<int>(
      std::count(valid.begin(), valid.begin() + components(), true));
}

int Dvl::Component(int row) const {
  int component = 0;
  for (int left = row; component < components(); ++component) {
    if (valid[static_cast<std::size_t>(component)] && left-- == 0) break;
  }
  return component;
}

Eigen::Vector3d Dvl::Direction(int component) const {
  if (form == Form::kThreeAxis) return Eigen::Vector3d::Unit(component);
  const double azimuth = beam_azimuth + component * 0.5 * kPi;
  return {std::sin(beam_angle) * std::cos(azimuth),
          std::sin(beam_angle) * std::sin(azimuth), std::cos(beam_angle)};
}

namespace {

/// A Gauss-Markov state has one sigma, the largest of its axes: the error is
/// this of it, axis by axis.
Eigen::Vector3d ShareOf(const LastingError& error) {
  if (!error.sigma || !std::isfinite(error.tau)) return Eigen::Vector3d::Ones();
  return *error.sigma / error.sigma->maxCoeff();
}

}  // namespace

void Dvl::Evaluate(const ModelContext& context,
                   LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const State& x = context.state;
  const int sensor = context.sensor_index;
  // Every sensitivity but that to w is as without it.
  const BlockKind kind = water ? BlockKind::kCurrent : BlockKind::kGroundBias;
  const Eigen::Vector3d part =
      water ? -Eigen::Vector3d::Ones() : ShareOf(context.sensor.ground_bias);
  const Eigen::Vector3d bias_part = ShareOf(context.sensor.bias);
  const Eigen::Vector3d w = part.cwiseProduct(
      Parameter3(layout, x, kind, sensor, Eigen::Vector3d::Zero()));
  const Eigen::Vector3d e = bias_part.cwiseProduct(Parameter3(
      layout, x, BlockKind::kBias, sensor, context.sensor.bias.value));
  const PointMotion motion = MotionOfSensor(context);
  const SensorAxes axes = AxesOfSensor(context, motion);
  const Eigen::Vector3d u_e = motion.v_e + motion.C_en * w;
  const Eigen::Vector3d v_d = axes.C_se * u_e + e;
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
  layout.AddColumns(BlockKind::kBias, sensor, A * bias_part.asDiagonal(),
                    &out->H);
  if (!layout.Has(kind, sensor)) return;
  const RowTimes3 A_n = A * axes.C_se * motion.C_en;
  layout.AddColumns(kind, sensor, A_n * part.asDiagonal(), &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    -A_n * Skew(w) * NedTurn(x.p_e), &out->H);
}

}  // namespace hindsight
