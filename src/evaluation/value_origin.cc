#include "evaluation/value_origin.h"

namespace hindsight {
namespace {

ValueOrigin OfStart(bool given, const std::string& key) {
  return {given, "initial." + key, "initial." + key + "_sigma", ""};
}

/// A bias whose sigma alone is given begins at zero.
ValueOrigin OfBias(bool given, const std::string& key,
                   const Eigen::Vector3d& bias) {
  ValueOrigin origin = OfStart(given, key);
  if (bias.isZero()) {
    origin.instead = "zero, as no " + origin.key + " is given";
  }
  return origin;
}

/// The word of a configuration for a constant of a sensor.
const char* WordOf(BlockKind kind) {
  switch (kind) {
    case BlockKind::kScale:
      return "scale";
    case BlockKind::kMounting:
      return "mounting";
    case BlockKind::kLeverArm:
      return "lever_arm";
    case BlockKind::kTimeOffset:
      return "time_offset";
    case BlockKind::kOffset:
      return "offset";
    case BlockKind::kHardIron:
      return "hard_iron";
    case BlockKind::kDeclination:
      return "declination";
    default:
      return nullptr;
  }
}

ValueOrigin OfSensor(const Judged& judged, const Block& block) {
  const auto i = static_cast<std::size_t>(block.key.sensor);
  if (i >= judged.sensors.size()) return {true, block.name, block.name, ""};
  const Sensor& sensor = judged.sensors[i];
  const std::string stream = "aiding." + sensor.name;
  const char* word = WordOf(block.key.kind);
  if (block.key.kind == BlockKind::kBias ||
      block.key.kind == BlockKind::kGroundBias) {
    const std::string key =
        stream +
        (block.key.kind == BlockKind::kBias ? ".bias" : ".ground_bias") +
        ".sigma";
    return {true, key, key, ""};
  }
  if (word == nullptr) return {true, stream, stream, ""};
  // A mounting that the direction of travel has turned is the program's own.
  const bool found =
      block.key.kind == BlockKind::kMounting &&
      !judged.start->x.parameters.segment<3>(block.parameter_offset).isZero();
  return {!found, stream + "." + word, stream + ".estimate." + word, ""};
}

}  // namespace

ValueOrigin OriginOf(const Judged& judged, const Block& block, int axis) {
  const InitialState& given = judged.start->given;
  switch (block.key.kind) {
    case BlockKind::kPosition:
      return OfStart(given.position.has_value(), "position");
    case BlockKind::kVelocity:
      return OfStart(given.v_n.has_value(), "velocity");
    case BlockKind::kAttitude:
      if (given.heading && axis == 2) {
        return {true, "initial.heading", "initial.attitude_sigma", ""};
      }
      return OfStart(given.euler.has_value(), "attitude");
    case BlockKind::kGyroBias:
      return OfBias(given.gyro_bias_sigma.has_value() &&
                        judged.start->x.b_g == given.gyro_bias,
                    "gyro_bias", given.gyro_bias);
    case BlockKind::kAccelBias:
      return OfBias(given.accel_bias_sigma.has_value(), "accel_bias",
                    given.accel_bias);
    case BlockKind::kGyroScale:
    case BlockKind::kAccelScale:
      return {true, "imu.estimate." + block.name, "imu.estimate." + block.name,
              ""};
    default:
      return OfSensor(judged, block);
  }
}

ValueOrigin OriginOf(const ConstantEstimate& one) {
  if (one.name.starts_with("gyro_scale")) {
    return {true, "the gyros' unit, scale or clock", "imu.estimate.gyro_scale",
            ""};
  }
  if (one.name.starts_with("accel_bias")) {
    return {true, "the accelerometers' calibration", "initial.accel_bias_sigma",
            ""};
  }
  return {true, one.name, "sigma of " + one.name, ""};
}

ValueOrigin OriginOfGivenGyroBias(const InitialState& given) {
  return OfBias(true, "gyro_bias", given.gyro_bias);
}

}  // namespace hindsight
