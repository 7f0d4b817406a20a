#include "simulation/calibration_drive.h"

#include "base/units.h"
#include "simulation/builtin_scenarios.h"

namespace hindsight {
namespace {

ImuErrorModel UncalibratedImu() {
  ImuErrorModel imu;
  imu.noise.gyro_noise_density = 0.1 * kDegreePerSqrtHour;
  imu.noise.accel_noise_density = 0.05 / 60.0;
  imu.gyro_bias_sigma.setConstant(10.0 * kDegree / kHour);
  imu.accel_bias_sigma.setConstant(2.0 * kMilliG);
  imu.gyro_scale_sigma.setConstant(2e-3);
  imu.accel_scale_sigma.setConstant(2e-3);
  return imu;
}

AidingModel UncalibratedGnss() {
  AidingModel gnss;
  gnss.sensor.name = "gnss";
  gnss.sensor.type = SensorType::kPosition;
  gnss.sensor.lever_arm_b = {0.5, -0.3, -1.2};
  gnss.sensor.lever_arm_sigma = Eigen::Vector3d::Constant(0.2);
  gnss.sensor.time_offset = 0.05;
  gnss.sensor.time_offset_sigma = 0.03;
  gnss.sigma = {0.05, 0.05, 0.1};
  gnss.draw_calibration = true;
  return gnss;
}

AidingModel UncalibratedOdometer() {
  AidingModel odometer;
  odometer.sensor.name = "odometer";
  odometer.sensor.type = SensorType::kOdometer;
  // The simulated IMU runs without side slip: the axle is beside it.
  odometer.sensor.lever_arm_b = {0.0, 0.2, 0.5};
  odometer.sensor.lever_arm_sigma = Eigen::Vector3d::Constant(0.2);
  odometer.sensor.scale_sigma = 0.01;
  odometer.sensor.mounting_sigma = Eigen::Vector3d::Constant(2.0 * kDegree);
  odometer.sensor.time_offset = -0.03;
  odometer.sensor.time_offset_sigma = 0.03;
  odometer.sigma.setConstant(0.05);
  odometer.rate_hz = 2.0;
  odometer.draw_calibration = true;
  return odometer;
}

}  // namespace

Scenario CalibrationDrive(double duration) {
  constexpr std::uint64_t kRouteSeed = 17;
  Scenario s;
  s.name = kCalibrationName;
  s.description = "car, everything to be calibrated, GNSS and odometer";
  s.start = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  s.start_heading = 40.0 * kDegree;
  s.duration = duration;
  s.segments = WanderingDrive(duration, kRouteSeed);
  s.imu_rate_hz = 100.0;
  s.imu = UncalibratedImu();
  s.aiding = {UncalibratedGnss(), UncalibratedOdometer()};
  s.truth_rate_hz = 1.0;
  StartErrors errors;
  errors.position.setConstant(0.5);
  errors.velocity.setConstant(0.1);
  errors.attitude = {0.3 * kDegree, 0.3 * kDegree, 1.0 * kDegree};
  s.start_errors = errors;
  return s;
}

}  // namespace hindsight
