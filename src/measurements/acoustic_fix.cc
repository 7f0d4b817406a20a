#include "measurements/acoustic_fix.h"

#include <cmath>

#include "measurements/sensor_axes.h"

namespace hindsight {
namespace {

/// e_1 and e_2 as rows.
Eigen::Matrix<double, 2, 3> Across(double azimuth, double depression) {
  const double sa = std::sin(azimuth);
  const double ca = std::cos(azimuth);
  const double sd = std::sin(depression);
  const double cd = std::cos(depression);
  Eigen::Matrix<double, 2, 3> across;
  across << -sa, ca, 0.0, -sd * ca, -sd * sa, cd;
  return across;
}

}  // namespace

void AcousticFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const int sensor = context.sensor_index;
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Vector3d d_e = p_t_e - motion.p_e;
  const double r = d_e.norm();
  const Eigen::Vector3d u_e = d_e / r;
  out->Resize(rows(), layout.dim());
  int row = 0;
  if (has_range) {
    const double k = Parameter1(layout, context.state, BlockKind::kScale,
                                sensor, context.sensor.scale);
    out->residual(0) = range - (1.0 + k) * r;
    out->R(0, 0) = sigma_range * sigma_range;
    RowJacobian H = RowJacobian::Zero(1, layout.dim());
    AddPositionColumns(context, motion, -(1.0 + k) * u_e.transpose(), &H);
    layout.AddColumns(BlockKind::kScale, sensor,
                      Eigen::Matrix<double, 1, 1>::Constant(r), &H);
    out->H.topRows(1) = H;
    row = 1;
  }
  if (!has_bearing) return;
  const SensorAxes axes = AxesOfSensor(context, motion);
  const RowTimes3 A = Across(azimuth, depression);
  out->residual.segment<2>(row) = -(A * (axes.C_se * u_e));
  out->R.diagonal().segment<2>(row).setConstant(sigma_bearing * sigma_bearing);
  RowJacobian H = RowJacobian::Zero(2, layout.dim());
  // d u = -(I - u u') dp / r
  const Eigen::Matrix3d turn =
      -(Eigen::Matrix3d::Identity() - u_e * u_e.transpose()) / r;
  AddPositionColumns(context, motion, A * axes.C_se * turn, &H);
  AddAxesColumns(context, motion, axes, u_e, A, &H);
  out->H.middleRows(row, 2) = H;
}

}  // namespace hindsight
