#include "simulation/in_flight_alignment.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kImuRate = 100.0;  // [Hz]
constexpr double kCruiseSpeed = 150.0;
constexpr double kAlignmentTime = 150.0;  // what the segments add up to [s]
constexpr double kBank = 35.0 * kDegree;
constexpr double kTurnTime = 20.0;
constexpr double kTurnBlend = 3.0;
constexpr double kThrottleTime = 8.0;
constexpr double kThrottleBlend = 1.0;

/// Random stream of the bad start, clear of those of sensors and initial
/// values.
constexpr std::uint64_t kBadStartStream = 200;
constexpr std::uint64_t kMountStream = 201;

/// A turn that takes kTurnTime, blends included.
Segment TurnAt(double speed, double side) {
  const double rate = kStandardGravity * std::tan(kBank) / speed;
  Segment turn =
      Segment::BankedTurn(side * rate * (kTurnTime - kTurnBlend), rate);
  turn.blend = kTurnBlend;
  return turn;
}

Segment Throttle(double from, double to) {
  const double rate = std::abs(to - from) / (kThrottleTime - kThrottleBlend);
  Segment throttle = Segment::Accelerate(to, rate);
  throttle.blend = kThrottleBlend;
  return throttle;
}

std::vector<Segment> TurnsAndThrottle() {
  constexpr double kSpeeds[] = {kCruiseSpeed, 165.0, 145.0, 165.0, 150.0};
  std::vector<Segment> segments = {Segment::Straight(kFirstManoeuvre)};
  double side = 1.0;
  for (std::size_t i = 0; i < std::size(kSpeeds); ++i) {
    segments.push_back(TurnAt(kSpeeds[i], side));
    side = -side;
    if (i + 1 == std::size(kSpeeds)) break;
    segments.push_back(Segment::Straight(1.0));
    segments.push_back(Throttle(kSpeeds[i], kSpeeds[i + 1]));
    segments.push_back(Segment::Straight(1.0));
  }
  return segments;
}

}  // namespace

Scenario InFlightAlignment(const InFlightAlignmentOptions& options) {
  if (!(options.velocity_rate_hz > 0.0) || !(options.velocity_sigma > 0.0)) {
    throw InputError(
        "in_flight_alignment: velocity rate and sigma must be positive");
  }
  const double samples = kImuRate / options.velocity_rate_hz;
  if (samples < 0.5 || std::abs(samples - std::round(samples)) > 1e-6) {
    throw InputError(
        "in_flight_alignment: velocity rate must be the IMU's 100 Hz divided "
        "by a whole number");
  }
  if (samples > kAlignmentTime * kImuRate) {
    throw InputError(
        "in_flight_alignment: a velocity rate below 1/150 Hz gives one "
        "velocity in all of the flight");
  }
  Scenario s;
  s.name = kInFlightAlignmentName;
  s.description =
      "aircraft, 150 s at 150 m/s and 100 Hz, banked turns, velocity 0.1 m/s, "
      "no initial attitude";
  s.start = {48.0 * kDegree, 11.5 * kDegree, 3000.0};
  s.start_speed = kCruiseSpeed;
  s.start_heading = 70.0 * kDegree;
  s.segments = TurnsAndThrottle();
  s.imu_rate_hz = kImuRate;
  // Truth at every velocity, where the filters have their nodes.
  const double truths = s.truth_rate_hz / options.velocity_rate_hz;
  if (std::abs(truths - std::round(truths)) > 1e-6) {
    s.truth_rate_hz = kImuRate;
  }
  s.imu.noise.gyro_noise_density = 0.1 * kDegreePerSqrtHour;
  s.imu.noise.accel_noise_density = 100.0 * kMicroG;
  s.imu.gyro_bias_sigma.setConstant(3.0 * kDegree / kHour);
  s.imu.accel_bias_sigma.setConstant(kMilliG);
  AidingModel velocity;
  velocity.sensor.name = "velocity";
  velocity.sensor.type = SensorType::kVelocity;
  velocity.rate_hz = options.velocity_rate_hz;
  velocity.sigma.setConstant(options.velocity_sigma);
  s.aiding.push_back(velocity);
  s.start_errors = StartErrors{};
  s.start_errors->position.setConstant(10.0);
  s.start_errors->position_alone = true;
  return s;
}

void GiveBadStart(const BadStart& start, std::uint64_t seed, Dataset* dataset) {
  Random random(seed, kBadStartStream);
  const double direction = 2.0 * kPi * random.Uniform();
  const double side = random.Uniform() < 0.5 ? -1.0 : 1.0;
  const Eigen::Vector3d tilt(start.tilt * std::cos(direction),
                             start.tilt * std::sin(direction), 0.0);
  const Eigen::Vector3d heading(0.0, 0.0, side * start.heading);
  const TruthPoint truth = dataset->truth.front();
  InitialState& initial = dataset->initial;
  initial.euler =
      EulerFromQuaternion(Exp(-tilt) * Exp(-heading) * truth.q_nb.value());
  initial.attitude_sigma =
      Eigen::Vector3d(start.tilt, start.tilt, start.heading);
  const auto first = std::get<VelocityFix>(
      dataset->streams.front().measurements.front().model);
  initial.v_n = first.v_n;
  initial.velocity_sigma = first.R_n.diagonal().cwiseSqrt();
}

void MountAnywhere(std::uint64_t seed, Dataset* dataset) {
  Random random(seed, kMountStream);
  Eigen::Vector4d v;
  for (int i = 0; i < 4; ++i) v(i) = random.Normal();
  const Eigen::Quaterniond q_bm = Eigen::Quaterniond(v).normalized();
  for (ImuSample& sample : dataset->imu.samples) {
    sample.gyro = q_bm * sample.gyro;
    sample.accel = q_bm * sample.accel;
  }
  for (TruthPoint& truth : dataset->truth.Edited()) {
    truth.q_nb = *truth.q_nb * q_bm.conjugate();
    truth.b_g = q_bm * *truth.b_g;
    truth.b_a = q_bm * *truth.b_a;
  }
}

}  // namespace hindsight
