#include "measurements/odometer.h"

#include "measurements/sensor_axes.h"

namespace hindsight {

void Odometer::Evaluate(const ModelContext& context,
                        LinearizedMeasurement* out) const {
  if (form == Form::kIncrements) {
    EvaluateIncrement(context, out);
    return;
  }
  LinearizedMeasurement full;
  EvaluateSpeeds(context, &full);
  const int first = form == Form::kNonHolonomic ? 1 : 0;
  out->Resize(rows(), context.layout.dim());
  out->residual = full.residual.segment(first, rows());
  out->H = full.H.middleRows(first, rows());
  out->R = full.R.block(first, first, rows(), rows());
}

double PredictedSpeed(const ModelContext& context) {
  Odometer standing;
  standing.form = Odometer::Form::kForward;
  LinearizedMeasurement at;
  standing.Evaluate(context, &at);
  return -at.residual(0);
}

void Odometer::EvaluateIncrement(const ModelContext& context,
                                 LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const int sensor = context.sensor_index;
  out->Resize(1, layout.dim());
  out->residual(0) =
      distance -
      Parameter1(layout, context.state, BlockKind::kDistance, sensor, 0.0) -
      Parameter1(layout, context.state, BlockKind::kOffset, sensor, 0.0);
  const Eigen::Matrix<double, 1, 1> one(1.0);
  layout.AddColumns(BlockKind::kDistance, sensor, one, &out->H);
  layout.AddColumns(BlockKind::kOffset, sensor, one, &out->H);
  if (layout.Has(BlockKind::kTimeOffset, sensor)) {
    layout.AddColumns(BlockKind::kTimeOffset, sensor,
                      one * PredictedSpeed(context), &out->H);
  }
  out->R(0, 0) = sigma.x() * sigma.x();
}

void Odometer::EvaluateSpeeds(const ModelContext& context,
                              LinearizedMeasurement* full) const {
  const ErrorLayout& layout = context.layout;
  const State& x = context.state;
  const int sensor = context.sensor_index;
  const PointMotion motion = MotionOfSensor(context);
  const double k =
      Parameter1(layout, x, BlockKind::kScale, sensor, context.sensor.scale);
  const SensorAxes axes = AxesOfSensor(context, motion);
  const Eigen::Vector3d v_o = axes.C_se * motion.v_e;
  const Eigen::Vector3d gain(1.0 + k, 1.0, 1.0);

  full->Resize(3, layout.dim());
  full->residual = Eigen::Vector3d(speed, side_down.x(), side_down.y()) -
                   gain.cwiseProduct(v_o);
  full->R.diagonal() = sigma.cwiseAbs2();
  AddSensorVelocityColumns(context, motion, axes,
                           Eigen::Matrix3d(gain.asDiagonal()), &full->H);
  layout.AddColumns(BlockKind::kScale, sensor,
                    Eigen::Vector3d(v_o.x(), 0.0, 0.0), &full->H);
}

}  // namespace hindsight
