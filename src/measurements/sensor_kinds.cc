#include <algorithm>
#include <stdexcept>

#include "base/error.h"
#include "geometry/so3.h"
#include "measurements/heading.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<const SensorKind*>& TheList() {
  static std::vector<const SensorKind*> list = {
      &PositionKind(),        &VelocityKind(),     &HeightKind(),
      &DepthKind(),           &SpeedCourseKind(),  &OdometerKind(),
      &NonHolonomicKind(),    &DvlKind(),          &AcousticKind(),
      &MagnetometerKind(),    &HeadingKind(),      &ZeroVelocityKind(),
      &ZeroAngularRateKind(), &VehicleLevelKind(), &TiltKind(),
  };
  return list;
}

}  // namespace

const std::vector<const SensorKind*>& SensorKinds() { return TheList(); }

const SensorKind* FindSensorKind(std::string_view name) {
  const auto& all = SensorKinds();
  const auto at =
      std::find_if(all.begin(), all.end(),
                   [&](const SensorKind* kind) { return kind->name == name; });
  return at == all.end() ? nullptr : *at;
}

void AddSensorKind(const SensorKind& kind) {
  if (FindSensorKind(kind.name) != nullptr) {
    throw std::invalid_argument("there is a kind of sensor named " +
                                std::string(kind.name));
  }
  TheList().push_back(&kind);
}

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

SensorSettings SettingsOf(const SensorKind& kind) {
  SensorSettings settings;
  settings.sensor.kind = &kind;
  kind.prepare(&settings);
  return settings;
}

Eigen::Vector3d UncorrelatedSigma(const Eigen::Matrix3d& R) {
  if (!R.isDiagonal(0.0)) {
    throw InputError("correlated errors cannot be written as CSV");
  }
  return R.diagonal().cwiseSqrt();
}

Eigen::Vector3d PerfectVelocity(const Sensor& sensor, const Motion& motion) {
  return sensor.q_sb * (motion.q_eb.conjugate() * motion.v_e +
                        motion.w_eb_b.cross(sensor.lever_arm_b));
}

}  // namespace hindsight
