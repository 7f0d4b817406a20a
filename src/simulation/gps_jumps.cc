#include "simulation/gps_jumps.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kFlightTime = 250.0;

Injection Error(Injection::Kind kind, double size, double from, double to) {
  Injection injection;
  injection.sensor = "gnss";
  injection.kind = kind;
  injection.size = size;
  injection.from = from;
  injection.to = to;
  return injection;
}

std::vector<Segment> LevelFlight() {
  constexpr double kTurnBegin = 60.0;
  constexpr double kTurnTime = 30.0;
  constexpr double kBlend = 3.0;
  constexpr double kRate = 3.0 * kDegree;
  Segment turn = Segment::BankedTurn(kRate * (kTurnTime - kBlend), kRate);
  turn.blend = kBlend;
  return {Segment::Straight(kTurnBegin), turn,
          Segment::Straight(kFlightTime - kTurnBegin - kTurnTime)};
}

ImuErrorModel Imu() {
  ImuErrorModel imu;
  imu.noise.gyro_noise_density = 0.005 * kDegreePerSqrtHour;
  imu.noise.accel_noise_density = 10.0 * kMicroG;
  imu.gyro_bias_sigma.setConstant(0.005 * kDegree / kHour);
  imu.accel_bias_sigma.setConstant(100.0 * kMicroG);
  imu.accel_scale_sigma.setConstant(100e-6);
  return imu;
}

}  // namespace

const std::vector<GpsErrorProfile>& GpsErrorProfiles() {
  using Kind = Injection::Kind;
  constexpr double kEnd = std::numeric_limits<double>::infinity();
  static const std::vector<GpsErrorProfile> profiles = {
      {"none", {}},
      {"pulses",
       {Error(Kind::kPulse, 3.5, 120.0, 125.0),
        Error(Kind::kPulse, 12.5, 140.0, 150.0)}},
      {"spikes", {Error(Kind::kSpikes, 12.5, 100.0, 200.0)}},
      {"steps",
       {Error(Kind::kStep, 3.5, 120.0, 140.0),
        Error(Kind::kStep, 12.5, 140.0, kEnd)}},
      {"ramp", {Error(Kind::kRamp, 15.0, 120.0, 220.0)}},
      {"multipath", {Error(Kind::kMultipath, 5.0, 120.0, 180.0)}}};
  return profiles;
}

Scenario GpsJumps(const GpsJumpsOptions& options) {
  if (!(options.gps_sigma > 0.0) || !(options.gps_rate_hz > 0.0)) {
    throw InputError("gps_jumps: GPS sigma and rate must be positive");
  }
  if (options.gps_rate_hz * kFlightTime < 1.0) {
    throw InputError(
        "gps_jumps: a GPS rate below 1/250 Hz gives one position in all of the "
        "flight");
  }
  Scenario s;
  s.name = kGpsJumpsName;
  s.description =
      "aircraft, 250 s at 150 m/s and 100 Hz, satellite positions with pulses "
      "of 3.5 and 12.5 m";
  s.start = {36.0 * kDegree, 127.0 * kDegree, 1000.0};
  s.start_speed = 150.0;
  s.start_heading = 30.0 * kDegree;
  s.segments = LevelFlight();
  s.duration = kFlightTime;
  s.imu_rate_hz = kGpsJumpsImuRate;
  // Truth at every position, where the filters have their nodes.
  const double truths = s.truth_rate_hz / options.gps_rate_hz;
  if (std::abs(truths - std::round(truths)) > 1e-6) {
    s.truth_rate_hz = kGpsJumpsImuRate;
  }
  s.imu = Imu();
  AidingModel gnss;
  gnss.sensor.name = "gnss";
  gnss.sensor.type = SensorType::kPosition;
  gnss.rate_hz = options.gps_rate_hz;
  gnss.sigma.setConstant(options.gps_sigma);
  AidingModel height;
  height.sensor.name = "height";
  height.sensor.type = SensorType::kHeight;
  height.rate_hz = options.gps_rate_hz;
  height.sigma.setConstant(0.5);
  s.aiding = {gnss, height};
  s.start_errors = StartErrors{};
  s.start_errors->position.setConstant(5.0);
  s.start_errors->velocity.setConstant(0.1);
  s.start_errors->attitude = Eigen::Vector3d(0.006, 0.006, 0.05) * kDegree;
  std::string known;
  for (const GpsErrorProfile& profile : GpsErrorProfiles()) {
    if (profile.name == options.profile) {
      s.injections = profile.injections;
      return s;
    }
    known += (known.empty() ? "" : ", ") + profile.name;
  }
  throw InputError("unknown profile '" + options.profile + "'; known are " +
                   known);
}

}  // namespace hindsight
