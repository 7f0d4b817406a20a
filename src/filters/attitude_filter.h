#ifndef HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_
#define HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "filters/accelerometer_rule.h"
#include "filters/inertial_low_pass.h"
#include "filters/magnetic_reference.h"
#include "imu/imu_link.h"
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
  /// Between updates of the filter [s], 0: every sample. What lies closer
  /// together than a small part of those times says the same twice.
  double update_interval = 0.0;
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

/// What became of the readings of one update.
struct AttitudeVerdict {
  double accel_variance = 0.0;  ///< R in force [m^2/s^4]; infinity: not used
  bool magnetic_used = false;
  bool magnetic_disturbed = false;
};

/// The layout {attitude, gyro bias}.
ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start);

/// The forward filter of the layout {attitude, gyro bias}: the error-state
/// extended Kalman filter of forward_filter.h, in the same tangent
/// (C_nb = Exp(psi) C^_nb), with every matrix of fixed size. The attitude
/// follows every sample (Turn, and the readings with it); covariance and
/// updates come once an interval (Predict, the uses, Reset), which may be of
/// one sample. Time update, summed over the RotationSummaries of the interval:
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

  /// Turns through `dt` with rates linear from w0 to w1 [rad/s].
  void Turn(double dt, const Eigen::Vector3d& w0, const Eigen::Vector3d& w1);
  /// Low-pass and rule see the specific force at the current time [m/s^2].
  void AddForce(const Eigen::Vector3d& f_b);
  /// A reading taken at time t [s], turned to the current one; those of an
  /// interval are averaged in axes that do not turn.
  void AddField(const MagneticSample& reading);
  /// Looks for rest; dt since the sample before [s].
  void AddRest(double dt, const Eigen::Vector3d& w, const Eigen::Vector3d& f);

  /// Time update of the covariance over the turns since the last one.
  void Predict();
  /// Uses the force as last added.
  void UseAccelerometer();
  /// Uses the field of the interval, if there was a reading.
  void UseMagnetometer();
  /// Uses the rate if the body rests.
  void UseRest();
  /// Moves the corrections into the state. To be called after the updates.
  void Reset();

  AttitudeState state() const;
  const Eigen::Vector3d& gyro_bias() const { return b_g_; }
  /// Verdict on the last update.
  const AttitudeVerdict& verdict() const { return verdict_; }
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

  /// Sums over the turns since the last Predict.
  struct Interval {
    double dt = 0.0;                              ///< [s]
    double phi = 1.0;                             ///< of the gyro bias
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();  ///< d psi / d b_g
    double q_attitude = 0.0;
    double q_bias = 0.0;
    int samples = 0;
    double angle = 0.0;  ///< [rad]
  };
  /// Readings of the field since the last update.
  struct FieldMean {
    Eigen::Vector3d sum_i = Eigen::Vector3d::Zero();  ///< weighed [uT]
    double weight = 0.0;                              ///< sum
    int count = 0;
    double t = 0.0;  ///< of the last [s]
  };

  const AttitudeFilterOptions& options_;
  const ImuNoise& noise_;
  Evolution bias_evolution_;
  AccelerometerRule rule_;
  MagneticReference reference_;
  std::optional<InertialLowPass> low_pass_;
  /// q_nb = q_ni q_ib: i turns with nothing but the gyros' integral, and the
  /// corrections move n to it.
  Eigen::Quaterniond q_ni_, q_ib_;
  Eigen::Matrix3d C_ib_;
  double t_;
  Eigen::Vector3d b_g_;
  Matrix6 P_;
  Vector6 dx_ = Vector6::Zero();
  Interval turned_;     ///< since the last Predict
  Interval predicted_;  ///< of the last Predict
  double dt_;           ///< between updates [s]
  Eigen::Vector3d f_i_ = Eigen::Vector3d::Zero();
  double force_variance_ = 0.0;  ///< of f_i_, by the rule alone [m^2/s^4]
  FieldMean field_;
  double field_t_;  ///< of the last reading used [s]
  Eigen::Vector3d rest_w_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_f_ = Eigen::Vector3d::Zero();
  double rest_for_ = 0.0;
  bool rest_started_ = false;
  AttitudeVerdict verdict_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_ATTITUDE_FILTER_H_
