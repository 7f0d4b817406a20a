#include "simulation/tunnel_survey.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kRigSpeed = 4.0;
constexpr double kAcceleration = 0.8;
constexpr double kRampUpTime = kRigSpeed / kAcceleration;
constexpr double kRampUpLength = 0.5 * kRigSpeed * kRampUpTime;
constexpr double kSurveyTime =
    2.0 * kRampUpTime + (kTunnelLength - 2.0 * kRampUpLength) / kRigSpeed;
constexpr double kSurveyImuRate = 100.0;

/// Changes of direction at a distance from the one before [m, deg]; the list is
/// repeated until the path is long enough.
struct Bend {
  double distance;
  double turn;
  double pitch;
};

const std::vector<Bend>& BendsOf(const std::string& path) {
  static const std::vector<Bend> winding = {
      {250.0, 45.0, 0.0},  {250.0, -90.0, 0.0}, {250.0, 0.0, 6.0},
      {100.0, 0.0, -6.0},  {250.0, 90.0, 0.0},  {250.0, 45.0, 0.0},
      {250.0, -90.0, 0.0}, {250.0, 0.0, -6.0},  {100.0, 0.0, 6.0},
      {250.0, -45.0, 0.0}, {250.0, 90.0, 0.0},  {250.0, -45.0, 0.0}};
  static const std::vector<Bend> serpentine = {
      {450.0, 90.0, 0.0}, {50.0, 90.0, 0.0},   {200.0, 0.0, 6.0},
      {50.0, 0.0, -6.0},  {200.0, -90.0, 0.0}, {50.0, -90.0, 0.0},
      {200.0, 0.0, -6.0}, {50.0, 0.0, 6.0},    {200.0, 90.0, 0.0},
      {50.0, 90.0, 0.0},  {450.0, -90.0, 0.0}, {50.0, -90.0, 0.0}};
  static const std::vector<Bend> straight = {
      {450.0, 15.0, 0.0}, {100.0, -15.0, 0.0}, {300.0, 0.0, 6.0},
      {100.0, 0.0, -6.0}, {450.0, -15.0, 0.0}, {100.0, 15.0, 0.0},
      {300.0, 0.0, -6.0}, {100.0, 0.0, 6.0}};
  if (path == "winding") return winding;
  if (path == "serpentine") return serpentine;
  if (path == "straight") return straight;
  std::string known;
  for (const std::string& name : TunnelPathNames()) {
    known += (known.empty() ? "" : ", ") + name;
  }
  throw InputError("unknown path '" + path + "'; known are " + known);
}

/// Appends a manoeuvre of stepped rate and returns the time it takes.
double Append(Segment segment, std::vector<Segment>* segments) {
  segment.blend = 0.0;
  segments->push_back(segment);
  return std::abs(segment.angle) / segment.rate;
}

std::vector<Segment> Drive(const std::vector<Bend>& bends) {
  constexpr double kYawRate = 45.0 * kDegree;
  constexpr double kPitchRate = 30.0 * kDegree;
  std::vector<Segment> segments;
  Append(Segment::Accelerate(kRigSpeed, kAcceleration), &segments);
  const double t_brake = kSurveyTime - kRampUpTime;
  double t = kRampUpTime;
  for (std::size_t i = 0;; ++i) {
    const Bend& bend = bends[i % bends.size()];
    const double hold = bend.distance / kRigSpeed;
    // The last bends are left out rather than cut.
    constexpr double kRoom = 10.0;
    if (t + hold + kRoom > t_brake) break;
    segments.push_back(Segment::Straight(hold));
    t += hold;
    if (bend.turn != 0.0) {
      t += Append(Segment::Turn(bend.turn * kDegree, kYawRate), &segments);
    }
    if (bend.pitch != 0.0) {
      t += Append(Segment::Pitch(bend.pitch * kDegree, kPitchRate), &segments);
    }
  }
  segments.push_back(Segment::Straight(t_brake - t));
  Append(Segment::Accelerate(0.0, kAcceleration), &segments);
  return segments;
}

ImuErrorModel TableOne(TunnelSurveyOptions::Noise noise) {
  constexpr double kDegreePerHour = kDegree / kHour;
  const double root_dt = noise == TunnelSurveyOptions::Noise::kSample
                             ? std::sqrt(1.0 / kSurveyImuRate)
                             : 1.0;
  ImuErrorModel imu;
  imu.gyro_bias_sigma.setConstant(3.0 * kDegreePerHour);
  imu.accel_bias_sigma.setConstant(1000.0 * kMicroG);
  imu.noise.gyro_noise_density = 0.35 * kDegreePerHour * root_dt;
  imu.noise.accel_noise_density = 50.0 * kMicroG * root_dt;
  return imu;
}

AidingModel OdometerModel(const TunnelSurveyOptions& options) {
  AidingModel model;
  model.sensor.name = "odometer";
  model.sensor.type = SensorType::kOdometer;
  model.sensor.scale_sigma = 1e-3;
  model.sigma.setConstant(options.odometer_sigma);
  model.odometer_form = options.odometer_form;
  return model;
}

AidingModel ReferencePoints(double spacing) {
  AidingModel model;
  model.sensor.name = "reference";
  model.sensor.type = SensorType::kPosition;
  model.sigma.setConstant(0.2);
  model.times = ReferenceTimes(spacing);
  return model;
}

}  // namespace

std::vector<std::string> TunnelPathNames() {
  return {"winding", "serpentine", "straight"};
}

std::vector<double> ReferenceTimes(double spacing) {
  std::vector<double> times;
  const double s_brake = kTunnelLength - kRampUpLength;
  for (int i = 1; i * spacing <= kTunnelLength; ++i) {
    const double s = i * spacing;
    if (s <= kRampUpLength) {
      times.push_back(std::sqrt(2.0 * s / kAcceleration));
    } else if (s <= s_brake) {
      times.push_back(kRampUpTime + (s - kRampUpLength) / kRigSpeed);
    } else {
      times.push_back(kSurveyTime -
                      std::sqrt(2.0 * (kTunnelLength - s) / kAcceleration));
    }
  }
  return times;
}

Scenario TunnelSurvey(const TunnelSurveyOptions& options) {
  if (!(options.reference_spacing > 0.0) || !(options.odometer_sigma > 0.0)) {
    throw InputError(
        "tunnel_survey: reference spacing and odometer noise must be positive");
  }
  Scenario s;
  s.name = kTunnelSurveyName;
  s.description =
      "survey vehicle, 8 km in 2005 s at 100 Hz, odometer 1 Hz, reference "
      "points every 2 km";
  s.start = {37.0 * kDegree, 127.0 * kDegree, 0.0};
  s.segments = Drive(BendsOf(options.path));
  s.imu_rate_hz = kSurveyImuRate;
  s.imu = TableOne(options.noise);
  s.aiding = {OdometerModel(options),
              ReferencePoints(options.reference_spacing)};
  s.start_errors = StartErrors{};
  s.start_errors->position.setConstant(0.2);
  s.start_errors->velocity.setConstant(0.01);
  s.start_errors->attitude = Eigen::Vector3d(1.0, 1.0, 2.0) * kDegree;
  return s;
}

}  // namespace hindsight
