#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/numeric_jacobian.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

Motion TurningMotion(const State& x) {
  Motion motion;
  motion.t = x.t;
  motion.p_e = x.p_e;
  motion.v_e = x.v_e;
  motion.q_eb = x.q_eb;
  motion.w_eb_b = {0.11, -0.23, 0.31};
  return motion;
}

bool HasKey(const SensorKind& kind, const char* name) {
  return std::ranges::any_of(
      kind.keys, [&](const SensorKey& key) { return key.name == name; });
}

/// Off the IMU, turned, scaled and with all that a kind knows of its own, where
/// a configuration can say so.
SensorSettings Mounted(const SensorKind& kind, const State& x) {
  SensorSettings settings = SettingsOf(kind);
  Sensor& sensor = settings.sensor;
  if (HasKey(kind, "lever_arm")) sensor.lever_arm_b = {1.2, -0.4, 0.3};
  if (HasKey(kind, "mounting")) {
    sensor.q_sb = Exp(Eigen::Vector3d(0.1, 0.2, -0.3));
  }
  sensor.magnetic.horizontal = 20.0;
  sensor.magnetic.down = 40.0;
  sensor.magnetic.declination = 0.05;
  sensor.magnetic.hard_iron_b = {0.5, -0.3, 0.2};
  sensor.own_vector = {2.0, 0.3, -0.1};
  if (auto* fix = std::get_if<AcousticFix>(&settings.pattern)) {
    fix->p_t_e = x.p_e + NedAxes(x.p_e) * Eigen::Vector3d(40.0, -30.0, 25.0);
    fix->has_range = fix->has_bearing = true;
  }
  // The vehicle slides, which the other rows of an axle exclude.
  if (auto* odometer = std::get_if<Odometer>(&settings.pattern)) {
    odometer->form = Odometer::Form::kForward;
  }
  return settings;
}

/// The simulation and the estimators have an equation each, which nothing but
/// this holds together.
TEST(PerfectSensor, LeavesNothingInTheModelOfItsKind) {
  const State x = testing::TypicalState();
  const Motion motion = TurningMotion(x);
  const ErrorLayout layout = testing::TypicalLayout();
  const Eigen::Vector3d earth_b = x.q_eb.conjugate() * EarthRate_e();
  const Kinematics kinematics = {motion.w_eb_b + earth_b + x.b_g, {}};
  std::vector<std::string> held;
  for (const SensorKind* kind : SensorKinds()) {
    if (kind->perfect == nullptr) continue;
    const SensorSettings settings = Mounted(*kind, x);
    const auto perfect = kind->perfect(settings, motion);
    if (!perfect) continue;
    LinearizedMeasurement at;
    Evaluate({x.t, 0, false, *perfect},
             {layout, x, kinematics, settings.sensor, 0, x.t}, &at);
    EXPECT_LT(at.residual.cwiseAbs().maxCoeff(), 1e-8) << kind->name;
    held.emplace_back(kind->name);
  }
  // All but zero velocities, which this motion does not have.
  EXPECT_GE(held.size(), 9U) << ::testing::PrintToString(held);
}

}  // namespace
}  // namespace hindsight
