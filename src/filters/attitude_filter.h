#ifndef HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_
#define HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "filters/accelerometer_rule.h"
#include "filters/inertial_low_pass.h"
#include "filters/linear_tape.h"
#include "filters/magnetic_reference.h"
#include "imu/imu_stream.h"
#include "measurements/magnetic_field.h"

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

struct AttitudeFilterOptions {
  AttitudePlace place;
  AccelerometerRuleOptions rule;
  /// Time constant of the accelerometer's low-pass in the quasi-inertial frame
  /// [s]; 0: the readings as they are. The rule then judges the filtered
  /// reading, whose sigma is that of one sample all the same.
  double low_pass_tau = 0.0;
  /// Of the magnetometer, per axis [uT].
  double magnetic_sigma = 1.0;
  /// Times over which the errors of accelerometer and magnetometer go on [s]:
  /// of samples dt apart each counts as dt / time of one, its variance is that
  /// of the rule, or sigma^2, times max(1, time / dt). 0: white.
  double accel_correlation_time = 0.0;
  double magnetic_correlation_time = 0.0;
  MagneticField::Form magnetic_form = MagneticField::Form::kHeading;
  /// The heading corrects heading (and what is correlated with it) alone: a
  /// disturbed field cannot tilt the horizon.
  bool decouple_heading = true;
  /// Of the vector form until the reference is learned; always the declination.
  MagneticSurroundings magnetic;
  MagneticReferenceOptions reference;
  /// Gyro rate at rest as a reading of the bias [rad/s]; 0: off. At rest all
  /// rates stay within `rest_rate` and all forces within `rest_force` of their
  /// low-passed values for `rest_time`.
  double rest_sigma = 0.0;
  double rest_rate = 0.035;  ///< [rad/s]
  double rest_force = 0.5;   ///< [m/s^2]
  double rest_time = 1.5;    ///< [s]
};

/// Mean and covariance of (attitude psi [rad, NED], gyro bias [rad/s]).
struct AttitudeState {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  double t = 0.0;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();
  Matrix6 P = Matrix6::Zero();
};

/// What became of one sample, beside the state after it.
struct AttitudeEpoch {
  AttitudeState x;
  double accel_variance = 0.0;  ///< R in force [m^2/s^4]; infinity: not used
  bool magnetic_used = false;
  bool magnetic_disturbed = false;
};

/// The layout {attitude, gyro bias}.
ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start);

/// The forward filter of the layout {attitude, gyro bias}: the error-state
/// extended Kalman filter of forward_filter.h, in the same tangent
/// (C_nb = Exp(psi) C^_nb), with every matrix of fixed size, light enough for
/// an update at every sample. Time update of RotationSummary:
///   psi' = psi - C_nb dt db_g + noise,   db_g' = db_g + walk.
/// Measurements, isotropic and therefore resolved in n, row by row:
///   C_nb f_b = -g e_D,   rows north and east of g [psi x] e_D,
///   C_nb m_b = m_n,      rows of Skew(m_n) psi, or the azimuth alone.
/// Neglected against the general filter: w_ie x psi over one sample, and the
/// transport of P over corrections (both below 1e-3 of P for corrections of
/// 1 mrad).
class AttitudeFilter {
 public:
  AttitudeFilter(const AttitudeFilterOptions& options, const ImuNoise& noise,
                 const AttitudeState& start, double sample_interval);

  /// Time update over `dt` with rates linear from w0 to w1 [rad/s].
  void Predict(double dt, const Eigen::Vector3d& w0, const Eigen::Vector3d& w1);
  /// Uses the specific force at the current time [m/s^2].
  void UseAccelerometer(const Eigen::Vector3d& f_b);
  /// Uses the field at the current time; dt since the reading before [s],
  /// `weight` as in MagneticSample.
  void UseMagnetometer(double dt, const Eigen::Vector3d& field_b,
                       double weight = 1.0);
  /// Uses the rate if the body rests; dt since the sample before [s].
  void UseRest(double dt, const Eigen::Vector3d& w, const Eigen::Vector3d& f);
  /// Moves the corrections into the state. To be called after the updates.
  void Reset();

  AttitudeState state() const;
  /// Verdicts since the last Reset.
  const AttitudeEpoch& epoch() const { return epoch_; }
  /// Transition and noise of the last Predict.
  void FillTransition(Transition* out) const;
  const Eigen::Matrix<double, 6, 1>& dx() const { return dx_; }
  const Eigen::Matrix<double, 6, 6>& P() const { return P_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  /// Scalar update with H = h on component `i`, residual about the nominal.
  void UpdateComponent(int i, double h, double residual, double R);
  /// Scalar update with H = h' on the attitude.
  void UpdateAttitude(const Eigen::Vector3d& h, double residual, double R);
  void ApplyGain(const Vector6& PHt, double S, double innovation);

  const AttitudeFilterOptions& options_;
  const ImuNoise& noise_;
  AccelerometerRule rule_;
  MagneticReference reference_;
  std::optional<InertialLowPass> low_pass_;
  /// q_nb = q_ni q_ib: i turns with nothing but the gyros' integral, and the
  /// corrections move n to it.
  Eigen::Quaterniond q_ni_, q_ib_;
  Eigen::Matrix3d C_nb_;
  double dt_;  ///< of the last sample [s]
  double t_;
  Eigen::Vector3d b_g_;
  Matrix6 P_;
  Vector6 dx_ = Vector6::Zero();
  Eigen::Matrix3d A_ = Eigen::Matrix3d::Zero();  ///< d psi / d b_g of Predict
  double q_attitude_ = 0.0;
  double q_bias_ = 0.0;
  double rate_ = 0.0;
  Eigen::Vector3d rest_w_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_f_ = Eigen::Vector3d::Zero();
  double rest_for_ = 0.0;
  bool rest_started_ = false;
  AttitudeEpoch epoch_;
};

struct AttitudeRun {
  std::vector<AttitudeEpoch> epochs;  ///< one a sample
};

/// Runs the filter over a record of rates; each magnetic sample is used at the
/// first IMU sample that is not earlier, turned there by the gyros. `tape`, if
/// not null, receives every epoch for the RTS smoother. `poll` is called now
/// and then with the samples done, and may throw.
AttitudeRun RunAttitudeFilter(
    const ImuStream& imu, std::span<const MagneticSample> magnetic,
    const AttitudeFilterOptions& options, const AttitudeState& start,
    LinearTape* tape = nullptr,
    const std::function<void(std::size_t)>& poll = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_
