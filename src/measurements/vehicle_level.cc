#include "measurements/vehicle_level.h"

#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

void VehicleLevel::Evaluate(const ModelContext& context,
                            LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const State& x = context.state;
  const int vehicle = context.sensor.vehicle;
  const Eigen::Vector3d m = Parameter3(layout, x, BlockKind::kMounting, vehicle,
                                       Eigen::Vector3d::Zero());
  const Eigen::Matrix3d C_en = x.C_en();
  const Eigen::Vector3d down_e = C_en.col(2);
  const Eigen::Matrix3d C_oe =
      (Exp(m) * context.sensor.q_sb * x.q_eb.conjugate()).toRotationMatrix();
  const Eigen::Vector3d down_o = C_oe * down_e;
  out->Resize(rows(), layout.dim());
  out->residual(0) = -down_o.y();
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor,
                    C_oe.row(1) * Skew(down_e) * C_en, &out->H);
  layout.AddColumns(BlockKind::kMounting, vehicle,
                    -Skew(down_o).row(1) * LeftJacobian(m), &out->H);
  out->R(0, 0) = sigma * sigma;
}

const SensorKind& VehicleLevelKind() {
  static const SensorKind kKind = {
      .name = "vehicle_level",
      .help = "a vehicle that is level on average",
      .configured = false,
      .is_prior = true,
      .has_clock = false,
      .prepare = [](SensorSettings* s) { s->pattern = VehicleLevel(); },
  };
  return kKind;
}

}  // namespace hindsight
