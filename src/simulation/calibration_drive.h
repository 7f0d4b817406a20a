#ifndef HINDSIGHT_SIMULATION_CALIBRATION_DRIVE_H_
#define HINDSIGHT_SIMULATION_CALIBRATION_DRIVE_H_

#include "simulation/scenario.h"

namespace hindsight {

inline constexpr char kCalibrationName[] = "calibration";

/// A drive of `duration` [s] on which nothing is known exactly: lever arms and
/// time offsets of GNSS and odometer, the odometer's scale, the mounting of the
/// IMU in the vehicle, and the scale factors of the IMU are all drawn from
/// their a priori sigmas and estimated. IMU 100 Hz, 0.1 deg/sqrt(h), 0.05
/// m/s/sqrt(h), biases of 10 deg/h and 2 mg, scale factors of 2000 ppm; GNSS 1
/// Hz, 5/5/10 cm; odometer with zero side and down speed 2 Hz, 0.05 m/s.
Scenario CalibrationDrive(double duration);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_CALIBRATION_DRIVE_H_
