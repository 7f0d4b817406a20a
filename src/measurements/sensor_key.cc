#include "measurements/sensor_key.h"

namespace hindsight {

SensorKey LeverArmKey() {
  return {.name = "lever_arm",
          .quantity = Quantity::kLength,
          .value = SensorKey::Vector{[](SensorSettings& s) {
            return &s.sensor.lever_arm_b;
          }},
          .help = "from the IMU, body axes"};
}

SensorKey LeverArmSigmaKey() {
  return {.name = "estimate.lever_arm",
          .quantity = Quantity::kLength,
          .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
            return &s.sensor.lever_arm_sigma;
          }},
          .help = "a priori sigma of an estimated one"};
}

SensorKey MountingKey(bool may_be_unknown) {
  return {
      .name = "mounting",
      .quantity = Quantity::kAngle,
      .value = SensorKey::Mounting{may_be_unknown},
      .help = may_be_unknown
                  ? "roll, pitch, yaw: vehicle = Rz(yaw) Ry(pitch) Rx(roll) "
                    "body; or `unknown`: the first value comes from the data"
                  : "roll, pitch, yaw: sensor = Rz(yaw) Ry(pitch) Rx(roll) "
                    "body"};
}

SensorKey MountingSigmaKey() {
  return {
      .name = "estimate.mounting",
      .quantity = Quantity::kAngle,
      .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
        return &s.sensor.mounting_sigma;
      }},
      .help = "a priori sigma of an estimated one; 10 deg of an unknown one"};
}

SensorKey ScaleKey() {
  return {.name = "scale",
          .value = SensorKey::Number{[](SensorSettings& s) {
                                       return &s.sensor.scale;
                                     },
                                     SensorKey::Range::kScale},
          .help = "measured = (1 + scale) true"};
}

SensorKey ScaleSigmaKey() {
  return {.name = "estimate.scale",
          .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
            return &s.sensor.scale_sigma;
          }},
          .help = "a priori sigma of an estimated one"};
}

SensorKey SigmaKey(Quantity quantity, bool one, std::string_view help) {
  return {.name = "sigma",
          .quantity = quantity,
          .value =
              SensorKey::OptionalSigmas{
                  [](SensorSettings& s) { return &s.sigma; }, one},
          .help = help};
}

SensorKey NeededSigmaKey(Quantity quantity, std::string_view help) {
  SensorKey key = SigmaKey(quantity, true, help);
  key.needed = Always;
  return key;
}

}  // namespace hindsight
