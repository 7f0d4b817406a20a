#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "measurements/robust_loss.h"

namespace hindsight {

enum class SensorType {
  kPosition,
  kVelocity,
  kHeight,
  kZeroVelocity,
  kZeroAngularRate,
  kOdometer,
  kNonHolonomic,
  kSpeedCourse,
  kDvl,
  kMagnetometer,
};

/// What is known of one aiding sensor beforehand: geometry, calibration and how
/// its measurements are to be trusted. Values in a layout take precedence.
struct Sensor {
  std::string name;  ///< key of the stream in the configuration
  SensorType type = SensorType::kPosition;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< IMU to sensor [m]
  /// Sensor axes from body axes, v_s = q_sb * v_b.
  Eigen::Quaterniond q_sb = Eigen::Quaterniond::Identity();
  double scale = 0.0;        ///< k: measured = (1 + k) true
  double time_offset = 0.0;  ///< true time = stamp + time_offset [s]
  /// Probability that a good measurement passes the chi-square gate; absent:
  /// no gate.
  std::optional<double> gate_probability;
  /// Robust loss of the whole-interval methods; forward filters weigh a
  /// measurement by it at its innovation.
  RobustLoss loss;
  /// A priori standard deviations of calibration states; absent: not estimated.
  std::optional<Eigen::Vector3d> lever_arm_sigma;
  std::optional<Eigen::Vector3d> mounting_sigma;
  std::optional<double> scale_sigma;
  std::optional<double> time_offset_sigma;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_H_
