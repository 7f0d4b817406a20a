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
