#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "measurements/robust_loss.h"

namespace hindsight {

struct SensorKind;
struct NoiseKind;

/// The kind of a stream of positions (measurements/position_fix.h).
const SensorKind& PositionKind();
/// Errors of which each is independent of all others.
const NoiseKind& WhiteNoise();

/// The Earth's field around a magnetometer and the vehicle's own.
struct MagneticSurroundings {
  /// Undisturbed field, horizontal (towards magnetic north) and down [uT].
  /// The heading-only form uses the horizontal part alone, as a scale of noise.
  double horizontal = 20.0;
  double down = 40.0;
  double declination = 0.0;  ///< of magnetic from true north, east + [rad]
  /// Field that turns with the vehicle, body axes [uT].
  Eigen::Vector3d hard_iron_b = Eigen::Vector3d::Zero();
  /// A priori standard deviations; absent: not estimated. The disturbance is a
  /// Gauss-Markov process in NED axes with this correlation time [s].
  std::optional<Eigen::Vector3d> hard_iron_sigma;
  std::optional<double> declination_sigma;
  std::optional<double> disturbance_sigma;
  double disturbance_tau = 10.0;
};

/// How a sensor's errors are correlated in time. A correlated error is a state
/// of the layout, kColouredNoise or, of a height, kOffset, in place of the
/// covariance stated with the measurements; what is left white beside it has
/// `white_sigma`.
struct NoiseModel {
  /// What the errors are (measurements/noise_kind.h).
  const NoiseKind* kind = &WhiteNoise();
  double sigma = 1.0;        ///< stationary, an axis [m or m/s]
  double tau = 10.0;         ///< correlation time [s]
  double white_sigma = 0.1;  ///< an axis [m or m/s]
  /// Value of a key that its kind alone has, in SI units.
  double own = 0.0;

  bool correlated() const;
};

/// An error of a measured velocity that outlasts many measurements. It is a
/// state of the layout if it has a sigma: constant, or Gauss-Markov,
///   e_k = phi e_k-1 + w,  phi = exp(-dt/tau),  w ~ (0, sigma^2 (1 - phi^2)).
struct LastingError {
  std::optional<Eigen::Vector3d> sigma;  ///< a priori, of each axis [m/s]
  double tau = std::numeric_limits<double>::infinity();  ///< [s]
  Eigen::Vector3d value = Eigen::Vector3d::Zero();       ///< a priori [m/s]
};

/// What is known of one aiding sensor beforehand: geometry, calibration and how
/// its measurements are to be trusted. Values in a layout take precedence.
struct Sensor {
  std::string name;  ///< key of the stream in the configuration
  /// What the sensor measures (measurements/sensor_kind.h).
  const SensorKind* kind = &PositionKind();
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< IMU to sensor [m]
  /// Sensor axes from body axes, v_s = q_sb * v_b.
  Eigen::Quaterniond q_sb = Eigen::Quaterniond::Identity();
  double scale = 0.0;             ///< k: measured = (1 + k) true
  double time_offset = 0.0;       ///< true time = stamp + time_offset [s]
  MagneticSurroundings magnetic;  ///< of a magnetometer
  /// Error of a counted distance that the next count does not inherit (the
  /// counter's resolution), white [m]; 0: none.
  double count_sigma = 0.0;
  /// Stream whose vehicle axes this sensor speaks of: its mounting is used.
  int vehicle = -1;
  /// Nothing is known of q_sb: the data must give a first value
  /// (alignment/mounting_search.h) before anything is estimated.
  bool mounting_unknown = false;
  /// Probability that a good measurement passes the chi-square gate; absent:
  /// no gate.
  std::optional<double> gate_probability;
  /// Robust loss of the whole-interval methods; forward filters weigh a
  /// measurement by it at its innovation.
  RobustLoss loss;
  NoiseModel noise;
  /// A priori standard deviations of calibration states; absent: not estimated.
  std::optional<Eigen::Vector3d> lever_arm_sigma;
  std::optional<Eigen::Vector3d> mounting_sigma;
  std::optional<double> scale_sigma;
  std::optional<double> time_offset_sigma;
  std::optional<double> offset_sigma;  ///< of a height or depth [m]
  double offset = 0.0;                 ///< a priori value of that [m]
  LastingError bias;                   ///< of a DVL's velocity, in its own axes
  LastingError ground_bias;            ///< of a DVL's bottom track, NED
  /// Water current that a DVL's water track is relative to: stationary standard
  /// deviation of each component [m/s]; correlated over time [s] or, if finite,
  /// over the distance travelled [m].
  std::optional<double> current_sigma;
  double current_tau = std::numeric_limits<double>::infinity();
  double current_length = std::numeric_limits<double>::infinity();
  /// Values of keys that its kind alone has, in SI units; the kind says which
  /// is which.
  std::array<double, 4> own = {};
  Eigen::Vector3d own_vector = Eigen::Vector3d::Zero();
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_H_
