#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_STATE_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_STATE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "attitude/inertial_low_pass.h"
#include "imu/imu_stream.h"
#include "measurements/heading.h"
#include "measurements/sensor.h"
#include "state/error_layout.h"
#include "state/state.h"

namespace hindsight {

/// Where an attitude is estimated. Without a place gravity is the standard one
/// and the Earth does not turn.
struct AttitudePlace {
  /// Without a place it only gives the NED axes a meaning: 45 deg north, where
  /// gravity is the standard one to 5e-5.
  Eigen::Vector3d p_e{4517590.87885, 0.0, 4487348.40887};
  double gravity = 9.80665;                          ///< [m/s^2]
  Eigen::Vector3d w_ie_n = Eigen::Vector3d::Zero();  ///< [rad/s]
};
/// Gravity and Earth rate at p_e.
AttitudePlace PlaceOnEarth(const Eigen::Vector3d& p_e);

/// One reading of a magnetometer in body axes, its own hard iron removed.
struct MagneticSample {
  double t = 0.0;  ///< [s], clock offset applied
  Eigen::Vector3d field_b = Eigen::Vector3d::Zero();  ///< [uT]
  /// Divides the variance; 0 makes the reading a disturbed one.
  double weight = 1.0;
};

/// One reading of a sensor of directions in the body, which outlives it.
struct HeadingSample {
  double t = 0.0;          ///< [s], clock offset applied
  GenericReading reading;  ///< of BaselineDirection()
  const Sensor* sensor = nullptr;
};

/// One velocity over the Earth of a point of the body.
struct VelocitySample {
  double t = 0.0;                                 ///< [s], clock offset applied
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Matrix3d R_n = Eigen::Matrix3d::Identity();      ///< [m^2/s^2]
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU [m]
};

/// What is read beside the IMU, each in order of time.
struct AttitudeReadings {
  std::span<const MagneticSample> magnetic = {};
  std::span<const HeadingSample> headings = {};
  std::span<const VelocitySample> velocities = {};
  /// In place of the IMU's forces, one a sample, in body axes; none: as they are.
  std::span<const BiasedForce> forces = {};
};

/// Mean and covariance of (attitude psi [rad, NED], gyro bias [rad/s], gyro
/// scale factors [1], accelerometer bias [m/s^2]: measured = (1 + s) true + b,
/// per body axis); P has behind these the dip of the field [rad], whose mean
/// concerns nobody but the filter.
struct AttitudeState {
  static constexpr int kGyroBias = 3;
  static constexpr int kGyroScale = 6;
  static constexpr int kAccelBias = 9;
  static constexpr int kDip = 12;
  static constexpr int kDim = 13;
  using Vector = Eigen::Matrix<double, kDim, 1>;
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  double t = 0.0;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();
  Eigen::Vector3d s_g = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();
  Matrix P = Matrix::Zero();
};

/// The layout {attitude, gyro bias, gyro scale, accelerometer bias}, which are the
/// first of AttitudeState.
ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start);

/// What became of the readings of one update.
struct AttitudeVerdict {
  double accel_variance = 0.0;  ///< R in force [m^2/s^4]; infinity: not used
  bool magnetic_used = false;
  bool magnetic_disturbed = false;
  /// Of the field that readings are held against, once learned; else 0 [uT].
  double horizontal = 0.0;
  double down = 0.0;
};

/// Transition of the error from one update to the next,
///   psi' = psi + A (db_g, ds_g) + noise,   db_g' = phi db_g + noise,
///   db_a' = phi_a db_a + noise,
/// and the error of the dip stays, or becomes a' psi + noise where the field that
/// is read becomes the reference.
struct AttitudeTransition {
  Eigen::Matrix<double, 3, 6> A = Eigen::Matrix<double, 3, 6>::Zero();
  double phi = 1.0;
  double phi_accel = 1.0;
  bool learns_dip = false;
  Eigen::Vector3d dip_by_psi = Eigen::Vector3d::Zero();  ///< a
  double q_attitude = 0.0;    ///< variance of an axis of the noise [rad^2]
  double q_bias = 0.0;        ///< the same of the gyro bias [rad^2/s^2]
  double q_accel_bias = 0.0;  ///< the same of the accelerometer's [m^2/s^4]
  double q_dip = 0.0;         ///< of the dip [rad^2]
};

/// What was read less what was predicted, each row over its predicted standard
/// deviation and after the rows before it were used: of a right model independent
/// N(0, 1).
struct AttitudeInnovation {
  enum class Source {
    kForce,     ///< the accelerometer's tilt, north and east
    kVelocity,  ///< what two velocities say
    kHeading,   ///< sensors of directions
    kField,     ///< the magnetometer
  };
  double t = 0.0;  ///< of the update [s]
  Source source = Source::kForce;
  RowVector rows;
};

/// One scalar reading as it was used: residual = h' d + noise.
struct ScalarUpdate {
  AttitudeState::Vector h;
  AttitudeState::Vector PHt;  ///< P h before it
  double S = 0.0;             ///< h' P h + R
  double innovation = 0.0;    ///< residual less h' of the mean before it
};

/// One update of the filter and the interval that ends there.
struct AttitudeNode {
  AttitudeState x;  ///< after the update
  AttitudeVerdict verdict;
  AttitudeTransition transition;
  AttitudeState::Vector dx = AttitudeState::Vector::Zero();  ///< of the update
  std::size_t updates_end = 0;  ///< of AttitudeRun::updates, exclusive
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_STATE_H_
