#include "simulation/uuv_scenarios.h"

#include "base/units.h"
#include "simulation/uuv_path.h"

namespace hindsight {
namespace {

const Geodetic kStart{35.0 * kDegree, 129.3 * kDegree, 0.0};
constexpr double kDiveImuRate = 100.0;

/// The usual fibre-optic unit of the 1 deg/h class: 0.07 deg/sqrt(h), 0.3 mg,
/// 50 ug/sqrt(Hz).
ImuErrorModel FibreOpticImu() {
  ImuErrorModel imu;
  imu.noise.gyro_noise_density = 0.07 * kDegreePerSqrtHour;
  imu.noise.accel_noise_density = 50.0 * kMicroG;
  imu.gyro_bias_sigma.setConstant(1.0 * kDegree / kHour);
  imu.accel_bias_sigma.setConstant(0.3 * kMilliG);
  return imu;
}

AidingModel DvlModel(Dvl::Form form) {
  constexpr double kSigma = 0.01;
  AidingModel model;
  model.sensor.name = "dvl";
  model.sensor.type = SensorType::kDvl;
  model.sensor.lever_arm_b = {1.2, 0.0, 0.4};
  model.draw_calibration = true;
  model.sensor.scale_sigma = 3e-3;
  model.sensor.mounting_sigma = Eigen::Vector3d::Constant(0.2 * kDegree);
  model.dvl.form = form;
  model.dvl.beam_angle = 30.0 * kDegree;
  model.dvl.beam_azimuth = 45.0 * kDegree;
  model.dvl.sigma.setConstant(kSigma);
  return model;
}

AidingModel DepthModel() {
  AidingModel model;
  model.sensor.name = "depth";
  model.sensor.type = SensorType::kHeight;
  model.sensor.lever_arm_b = {-0.5, 0.0, 0.1};
  model.sensor.offset_sigma = 0.3;
  model.sigma.setConstant(0.1);
  return model;
}

AidingModel Gnss(const std::string& name, double sigma) {
  AidingModel model;
  model.sensor.name = name;
  model.sensor.type = SensorType::kPosition;
  model.sensor.lever_arm_b = {0.2, 0.0, -0.8};
  model.sigma.setConstant(sigma);
  return model;
}

StartErrors AtTheSurface() {
  StartErrors errors;
  errors.position.setConstant(0.3);
  errors.velocity.setConstant(0.02);
  errors.attitude = Eigen::Vector3d(0.1, 0.1, 0.5) * kDegree;
  return errors;
}

}  // namespace

Scenario UuvSurvey(const UuvSurveyOptions& options) {
  constexpr double kProfileStep = 0.5;
  constexpr double kFinalSigma = 0.5;
  const UuvPath path = MakeUuvPath(options.path);
  Scenario s;
  s.name = options.path == "straight" ? kUuvStraightName : kUuvSurveyName;
  s.description = "underwater vehicle, " + options.path +
                  ", 1000 s at 100 m, tactical IMU, DVL and depth at 1 Hz";
  s.start = kStart;
  s.profile = path.Profile(kStart, kProfileStep);
  s.imu_rate_hz = kDiveImuRate;
  s.imu = FibreOpticImu();
  s.aiding = {DvlModel(options.form), DepthModel()};
  if (options.gap > 0.0) {
    const double middle = 0.5 * path.duration();
    s.aiding[0].outages.push_back(
        {middle - 0.5 * options.gap, middle + 0.5 * options.gap});
  }
  if (options.final_fix) {
    AidingModel fix = Gnss("fix", kFinalSigma);
    fix.times = {path.duration()};
    s.aiding.push_back(fix);
  }
  s.start_errors = AtTheSurface();
  return s;
}

Scenario UuvCalibration() {
  constexpr double kSpeed = 2.0;
  constexpr double kTurnRate = 6.0 * kDegree;
  constexpr int kEights = 5;
  Scenario s;
  s.name = kUuvCalibrationName;
  s.description =
      "underwater vehicle, figures of eight at the surface, GNSS, DVL told "
      "with wrong scale, boresight and lever arm";
  s.start = kStart;
  s.start_speed = kSpeed;
  s.segments = {Segment::Straight(20.0)};
  for (int i = 0; i < kEights; ++i) {
    s.segments.push_back(Segment::Turn(360.0 * kDegree, kTurnRate));
    s.segments.push_back(Segment::Turn(-360.0 * kDegree, kTurnRate));
  }
  s.imu_rate_hz = kDiveImuRate;
  s.imu = FibreOpticImu();
  AidingModel dvl = DvlModel(Dvl::Form::kBeams);
  dvl.sensor.scale_sigma = 0.01;
  dvl.sensor.mounting_sigma = Eigen::Vector3d::Constant(2.0 * kDegree);
  dvl.sensor.lever_arm_sigma = Eigen::Vector3d::Constant(0.3);
  constexpr double kGnssSigma = 0.5;
  s.aiding = {dvl, DepthModel(), Gnss("gnss", kGnssSigma)};
  s.start_errors = AtTheSurface();
  return s;
}

}  // namespace hindsight
