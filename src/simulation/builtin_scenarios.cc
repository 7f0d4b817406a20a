#include "simulation/builtin_scenarios.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "simulation/gps_jumps.h"
#include "simulation/in_flight_alignment.h"
#include "simulation/tunnel_survey.h"
#include "simulation/uuv_scenarios.h"

namespace hindsight {
namespace {

/// Tactical grade: 0.1 deg/sqrt(h), 0.05 m/s/sqrt(h), biases 3 deg/h and 1 mg
/// that stay constant.
ImuErrorModel TacticalImu() {
  ImuErrorModel imu;
  imu.noise.gyro_noise_density = 0.1 * kDegreePerSqrtHour;
  imu.noise.accel_noise_density = 0.05 / 60.0;
  imu.gyro_bias_sigma.setConstant(3.0 * kDegree / kHour);
  imu.accel_bias_sigma.setConstant(kMilliG);
  return imu;
}

AidingModel Gnss(SensorType type, const std::string& name,
                 const Eigen::Vector3d& sigma, const Eigen::Vector3d& l_b) {
  AidingModel model;
  model.sensor.name = name;
  model.sensor.type = type;
  model.sensor.lever_arm_b = l_b;
  model.sigma = sigma;
  return model;
}

StartErrors AlignedStart() {
  StartErrors errors;
  errors.position = {0.05, 0.05, 0.1};
  errors.velocity.setConstant(0.02);
  errors.attitude = {0.1 * kDegree, 0.1 * kDegree, 0.5 * kDegree};
  return errors;
}

Scenario CarDrive() {
  constexpr std::uint64_t kRouteSeed = 2002;
  Scenario s;
  s.name = "car_drive";
  s.description =
      "car, 30 min at 200 Hz, tactical IMU, GNSS 1 Hz 5/5/10 cm, three outages "
      "of 60 s";
  s.start = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  s.start_heading = 40.0 * kDegree;
  s.duration = 1800.0;
  s.segments = WanderingDrive(s.duration, kRouteSeed);
  s.imu = TacticalImu();
  s.aiding.push_back(Gnss(SensorType::kPosition, "gnss", {0.05, 0.05, 0.1},
                          {0.5, -0.3, -1.2}));
  s.start_errors = AlignedStart();
  // Starts at 450, 900 and 1350 s; a fourth would be cut by the end.
  s.withholdings.push_back({"gnss", 450.0, 60.0, std::nullopt});
  return s;
}

Scenario ShortDrive() {
  Scenario s;
  s.name = "short_drive";
  s.description =
      "car, 3 min at 100 Hz from standstill, GNSS position and velocity at 1 "
      "Hz";
  s.start = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  s.start_heading = 65.0 * kDegree;
  s.duration = 180.0;
  s.segments = {Segment::Stop(20.0),
                Segment::Accelerate(12.0, 1.8),
                Segment::Straight(12.0),
                Segment::Turn(90.0 * kDegree, 14.0 * kDegree),
                Segment::Straight(10.0),
                Segment::Pitch(3.0 * kDegree, 2.0 * kDegree),
                Segment::Straight(6.0),
                Segment::Pitch(-3.0 * kDegree, 2.0 * kDegree),
                Segment::Stop(12.0, 2.2),
                Segment::Accelerate(9.0, 2.0),
                Segment::Turn(-120.0 * kDegree, 16.0 * kDegree),
                Segment::Accelerate(15.0, 1.5),
                Segment::Straight(14.0),
                Segment::Turn(45.0 * kDegree, 9.0 * kDegree),
                Segment::Straight(8.0),
                Segment::Turn(-30.0 * kDegree, 9.0 * kDegree),
                Segment::Stop(60.0, 2.0)};
  s.imu_rate_hz = 100.0;
  s.imu = TacticalImu();
  const Eigen::Vector3d l_b(0.5, -0.3, -1.2);
  s.aiding.push_back(Gnss(SensorType::kPosition, "gnss", {0.5, 0.5, 1.0}, l_b));
  s.aiding.push_back(
      Gnss(SensorType::kVelocity, "gnss_velocity", {0.05, 0.05, 0.1}, l_b));
  s.stationary.enabled = true;
  return s;
}

Scenario Flight() {
  Scenario s;
  s.name = "flight";
  s.description =
      "aircraft, 10 min at 100 Hz, climbs and banked turns, GNSS position at "
      "1 Hz";
  s.start = {48.0 * kDegree, 11.5 * kDegree, 1500.0};
  s.start_speed = 80.0;
  s.start_heading = 270.0 * kDegree;
  s.duration = 600.0;
  for (int lap = 0; lap < 5; ++lap) {
    const double side = lap % 2 == 0 ? 1.0 : -1.0;
    for (const Segment& segment :
         {Segment::Straight(20.0),
          Segment::Pitch(side * 5.0 * kDegree, 1.5 * kDegree),
          Segment::Straight(25.0),
          Segment::Pitch(-side * 5.0 * kDegree, 1.5 * kDegree),
          Segment::BankedTurn(side * 180.0 * kDegree, 4.0 * kDegree),
          Segment::Straight(15.0),
          Segment::Accelerate(80.0 + 10.0 * side, 1.0)}) {
      s.segments.push_back(segment);
      s.segments.back().blend = 3.0;
    }
  }
  s.imu_rate_hz = 100.0;
  s.imu = TacticalImu();
  s.aiding.push_back(
      Gnss(SensorType::kPosition, "gnss", {1.0, 1.0, 2.0}, {-1.5, 0.0, -0.8}));
  s.start_errors = AlignedStart();
  return s;
}

struct Entry {
  const char* name;
  Scenario (*make)();
};
constexpr std::array<Entry, 9> kScenarios = {
    {{"car_drive", CarDrive},
     {"short_drive", ShortDrive},
     {"flight", Flight},
     {kTunnelSurveyName, [] { return TunnelSurvey({}); }},
     {kInFlightAlignmentName, [] { return InFlightAlignment({}); }},
     {kGpsJumpsName, [] { return GpsJumps({}); }},
     {kUuvSurveyName, [] { return UuvSurvey({}); }},
     {kUuvStraightName, [] { return UuvSurvey({.path = "straight"}); }},
     {kUuvCalibrationName, UuvCalibration}}};

/// Seconds that a segment takes at least, blending aside.
double LeastDuration(const Segment& s, double speed) {
  switch (s.kind) {
    case Segment::Kind::kStraight:
      return s.duration;
    case Segment::Kind::kStop:
      return s.duration + speed / s.rate;
    case Segment::Kind::kAccelerate:
      return std::abs(s.speed - speed) / s.rate;
    case Segment::Kind::kTurn:
    case Segment::Kind::kPitch:
      return std::abs(s.angle) / s.rate;
  }
  return 0.0;
}

}  // namespace

std::vector<std::string> BuiltinScenarioNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kScenarios) names.emplace_back(entry.name);
  return names;
}

Scenario BuiltinScenario(const std::string& name) {
  std::string known;
  for (const Entry& entry : kScenarios) {
    if (name == entry.name) return entry.make();
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError("'" + name + "' is no built-in scenario; there are " +
                   known);
}

std::vector<Segment> WanderingDrive(double duration, std::uint64_t seed) {
  constexpr double kLateralAcceleration = 2.7;
  Random random(seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * random.Uniform();
  };
  const auto sign = [&] { return random.Uniform() < 0.5 ? -1.0 : 1.0; };
  std::vector<Segment> segments;
  double total = 0.0;
  double speed = 0.0;
  const auto add = [&](const Segment& s) {
    total += LeastDuration(s, speed);
    if (s.kind == Segment::Kind::kAccelerate) speed = s.speed;
    if (s.kind == Segment::Kind::kStop) speed = 0.0;
    segments.push_back(s);
  };
  const auto turn = [&](double angle) {
    const double fastest = kLateralAcceleration / speed;
    add(Segment::Turn(angle, std::min(fastest, draw(10.0, 20.0) * kDegree)));
  };
  add(Segment::Stop(5.0));
  while (total < duration) {
    add(Segment::Accelerate(draw(9.0, 20.0), draw(1.0, 2.2)));
    add(Segment::Straight(draw(4.0, 15.0)));
    const double bend = sign() * draw(5.0, 35.0) * kDegree;
    turn(bend);
    add(Segment::Straight(draw(2.0, 12.0)));
    if (random.Uniform() < 0.5) {
      const double slope = sign() * draw(1.0, 4.0) * kDegree;
      add(Segment::Pitch(slope, 2.0 * kDegree));
      add(Segment::Straight(draw(3.0, 10.0)));
      add(Segment::Pitch(-slope, 2.0 * kDegree));
    }
    add(Segment::Accelerate(draw(6.0, 9.0), draw(1.2, 2.5)));
    turn(sign() * draw(45.0, 110.0) * kDegree);
    if (random.Uniform() < 0.25) add(Segment::Stop(draw(5.0, 15.0)));
  }
  return segments;
}

}  // namespace hindsight
