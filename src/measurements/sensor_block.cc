#include "measurements/sensor_block.h"

#include "geometry/so3.h"
#include "measurements/noise_kind.h"

namespace hindsight {

std::optional<Eigen::Vector3d> OnAllAxes(const std::optional<double>& sigma) {
  if (!sigma) return std::nullopt;
  return Eigen::Vector3d(Eigen::Vector3d::Constant(*sigma));
}

SensorBlock ScaleBlock() {
  return {.kind = BlockKind::kScale,
          .name = "scale",
          .unit = "1",
          .sigma =
              [](const Sensor& sensor, const MeasurementModel*) {
                return OnAllAxes(sensor.scale_sigma);
              },
          .value =
              [](const Sensor& sensor) {
                return Eigen::Vector3d(Eigen::Vector3d::Constant(sensor.scale));
              },
          .advice = "travel between position fixes",
          .know =
              [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
                 Sensor* sensor) {
                sensor->scale = value.x();
                sensor->scale_sigma = sigma.x();
              }};
}

SensorBlock MountingBlock() {
  return {
      .kind = BlockKind::kMounting,
      .name = "mounting",
      .unit = "rad",
      .sigma = [](const Sensor& sensor,
                  const MeasurementModel*) { return sensor.mounting_sigma; },
      .advice =
          "travel at speed with heading and slope known from turns; roll "
          "only from side slip in turns",
      .know =
          [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
             Sensor* sensor) {
            sensor->q_sb = Exp(value) * sensor->q_sb;
            sensor->mounting_sigma = sigma;
            sensor->mounting_unknown = false;
          }};
}

SensorBlock LeverArmBlock() {
  return {
      .kind = BlockKind::kLeverArm,
      .name = "lever_arm",
      .unit = "m",
      .sigma = [](const Sensor& sensor,
                  const MeasurementModel*) { return sensor.lever_arm_sigma; },
      .value = [](const Sensor& sensor) { return sensor.lever_arm_b; },
      .advice = "turns (forward and right arm), and roll and pitch (down arm)",
      .know =
          [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
             Sensor* sensor) {
            sensor->lever_arm_b = value;
            sensor->lever_arm_sigma = sigma;
          }};
}

SensorBlock TimeOffsetBlock() {
  return {.kind = BlockKind::kTimeOffset,
          .name = "time_offset",
          .unit = "s",
          .sigma =
              [](const Sensor& sensor, const MeasurementModel*) {
                return OnAllAxes(sensor.time_offset_sigma);
              },
          .value =
              [](const Sensor& sensor) {
                return Eigen::Vector3d(
                    Eigen::Vector3d::Constant(sensor.time_offset));
              },
          .advice = "changes of speed or direction",
          .know =
              [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
                 Sensor* sensor) {
                sensor->time_offset = value.x();
                sensor->time_offset_sigma = sigma.x();
              }};
}

SensorBlock NoiseBlock(BlockKind kind, std::string_view unit) {
  return {.kind = kind,
          .name = "noise",
          .unit = unit,
          .sigma =
              [](const Sensor& sensor, const MeasurementModel*) {
                return sensor.noise.correlated() ? OnAllAxes(sensor.noise.sigma)
                                                 : std::nullopt;
              },
          .evolution =
              [](const Sensor& sensor) {
                return sensor.noise.kind->evolution(sensor.noise);
              },
          .searched =
              [](const Sensor& sensor) { return sensor.noise.kind->searched; }};
}

}  // namespace hindsight
