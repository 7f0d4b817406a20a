#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_FILTER_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_FILTER_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "attitude/accelerometer_rule.h"
#include "attitude/attitude_state.h"
#include "attitude/inertial_low_pass.h"
#include "attitude/magnetic_reference.h"
#include "attitude/velocity_change.h"
#include "imu/imu_stream.h"
#include "measurements/magnetic_field.h"

namespace hindsight {

/// Of the dip of a field that is still to be learned: what may differ by more is
/// disturbed [rad].
inline constexpr double kUnknownDipSigma = 0.1745;

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
  /// disturbed field cannot tilt the horizon. What the tilt's error does to it
  /// is in the covariance, but where updates are recorded: a smoother's form
  /// asks for optimal gains, and there the tilt counts as known.
  bool decouple_heading = true;
  /// Of the vector form until the reference is learned; always the declination.
  MagneticSurroundings magnetic;
  /// Of the dip of that field [rad]; 0: exact. One that is learned is as wrong as
  /// the tilt: then the vector form tells changes of the tilt alone.
  double dip_sigma = 0.0;
  MagneticReferenceOptions reference;
  /// Of one sample of the gyros at rest as a reading of their bias [rad/s]; 0:
  /// rest is no knowledge.
  double rest_sigma = 0.0;
  /// Whether the body rests from each sample to the next; absent: where
  /// RestDetector, which knows nothing later, finds it.
  std::optional<std::vector<bool>> rests;
};

/// The forward filter of the layout AttitudeLayout(): the
/// error-state extended Kalman filter of filters/forward_filter.h, in the same
/// tangent (C_nb = Exp(psi) C^_nb), with every matrix of fixed size. The
/// attitude follows every sample (Turn, and the readings with it); covariance
/// and updates come once an interval (Predict, then the Use functions, then
/// Reset), which may be of one sample. Time update, summed over the
/// RotationSummaries of the interval:
///   psi' = psi - C_nb dt (db_g + diag(w) ds_g) + noise,   db_g' = db_g + walk,
///   ds_g' = ds_g,   db_a' = db_a + walk.
/// While the body is known to rest it does not turn over the Earth, whatever
/// the gyros read, but for their white noise, and what they read is their bias:
///   psi' = psi + noise,   w_ib = C_bn w_ie + b_g + noise.
/// Measurements are those of measurements/tilt.h, magnetic_field.h and
/// stationary.h; their noise is isotropic, so they are resolved in n and used
/// row by row:
///   C_nb (f_b - b_a) = -g e_D,   rows north and east of -g [e_D x] psi + C_nb db_a,
///   C_nb m_b = m_n,      rows of [m_n x] psi and of the dip's error, or the
///                        azimuth alone, whose variance is by the horizontal
///                        part that is read.
/// The third row of the former tells of the size of what is read, which is that of
/// gravity and of scale factors before it is one of a bias.
/// Two velocities say what the force between them is (VelocityChange), in rows of
///   [C_nb u_b x] psi  and of the IMU's errors.
/// How fast the body accelerates is known then, so that the tilt needs no rule,
/// and whoever accelerates knows the heading. An error that two intervals share
/// counts in each of them as if it were another one: sigmas are a little too
/// large.
/// Neglected against the general filter: w_ie x psi over one sample, what a
/// reading at rest tells of attitude and scale factor by the Earth's rate in
/// it, and the transport of P over corrections (all below 1e-3 of P for
/// corrections of 1 mrad).
class AttitudeFilter {
 public:
  AttitudeFilter(const AttitudeFilterOptions& options, const ImuNoise& noise,
                 const AttitudeState& start, double sample_interval);

  /// Turns through `dt` with rates linear from w0 to w1 [rad/s].
  void Turn(double dt, const Eigen::Vector3d& w0, const Eigen::Vector3d& w1);
  /// Low-pass and rule see the specific force at the current time, body axes.
  void AddForce(const BiasedForce& force);
  /// A reading taken at time t [s], turned to the current one; those of an
  /// interval are averaged in axes that do not turn.
  void AddField(const MagneticSample& reading);
  /// Whether the body rests from now on.
  void SetResting(bool resting) { resting_ = resting; }
  /// Whether the rate is one that the gyro bias explains, to three sigmas.
  bool ExplainsAsBias(const Eigen::Vector3d& w) const;

  /// Time update of the covariance over the turns since the last one.
  void Predict();
  /// Uses the force as last added, unless the rule passes it over. This and
  /// UseVelocityChange return the innovation, each row over its predicted standard
  /// deviation; empty: nothing was used.
  RowVector UseAccelerometer();
  /// Uses the field of the interval, if there was a reading. Returns as
  /// UseAccelerometer.
  RowVector UseMagnetometer();
  /// Uses a reading whose rows depend on the attitude alone, by psi, and returns
  /// its innovation over the predicted standard deviation.
  double UseRow(const Eigen::Vector3d& h, double residual, double R) {
    return UpdateAttitude(h, residual, R);
  }
  /// Goes without the accelerometer, as velocities say what it reads.
  void LeaveAccelerometer();
  /// Uses what two velocities say of the attitude at the later one, which is
  /// C_nb to now.
  RowVector UseVelocityChange(const VelocityChange& change,
                              const Eigen::Matrix3d& C_nb);
  /// Uses the rates that were read at rest since the last update.
  void UseRest();
  /// Moves the corrections into the state. To be called after the updates.
  void Reset();

  AttitudeState state() const;
  Eigen::Quaterniond q_nb() const { return q_ni_ * q_ib_; }
  const Eigen::Vector3d& gyro_bias() const { return b_g_; }
  const Eigen::Vector3d& gyro_scale() const { return s_g_; }
  const Eigen::Vector3d& accel_bias() const { return b_a_; }
  /// Verdict on the last update.
  const AttitudeVerdict& verdict() const { return verdict_; }
  /// Of the last Predict.
  const AttitudeTransition& transition() const { return transition_; }
  /// Mean of the error before Reset.
  const AttitudeState::Vector& dx() const { return dx_; }
  /// Every scalar update goes to `record`, too, if it is not null.
  void RecordUpdates(std::vector<ScalarUpdate>* record) { record_ = record; }

 private:
  using Vector = AttitudeState::Vector;
  using Matrix = AttitudeState::Matrix;

  /// Rows of the two forms of the field; u_n [uT], R [uT^2], [rad^2].
  RowVector UseFieldVector(const Eigen::Vector3d& u_n, double R);
  RowVector UseAzimuth(const Eigen::Vector3d& u_n, double R);
  /// Field that is expected, without disturbances [uT].
  Eigen::Vector3d ExpectedField() const;
  /// Scalar update with H = h on component `i`, residual about the nominal.
  double UpdateComponent(int i, double h, double residual, double R);
  /// Scalar update with H = h'.
  double UpdateState(const Vector& h, double residual, double R);
  /// Scalar update with H = h' on the attitude. Returns the innovation over its
  /// predicted standard deviation.
  double UpdateAttitude(const Eigen::Vector3d& h, double residual, double R);
  /// Scalar update with H = h' on the attitude that leaves tilt and accelerometer
  /// and counts its error (Schmidt 1966).
  double ConsiderTilt(const Eigen::Vector3d& h, double residual, double R);
  /// Puts the transition of the dip where the reference is a new one.
  void LearnDip();
  /// Time update of three components of P by a factor.
  void Scale(int begin, double phi);
  /// [m/s^2], in the axes of `force`.
  Eigen::Vector3d WithoutBias(const BiasedForce& force) const;
  void ApplyGain(const Vector& PHt, double S, double innovation);
  void Record(const Vector& h, const Vector& PHt, double S, double innovation);

  /// Sums over the turns since the last Predict.
  struct Interval {
    double dt = 0.0;                              ///< [s]
    double phi = 1.0;                             ///< of the gyro bias
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();  ///< d psi_i / d b_g
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();  ///< d psi_i / d s_g
    double q_attitude = 0.0;
    int samples = 0;
    double angle = 0.0;                                ///< [rad]
    Eigen::Vector3d rest_w = Eigen::Vector3d::Zero();  ///< sum at rest [rad/s]
    int resting = 0;                                   ///< samples at rest
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
  Evolution accel_evolution_;
  AccelerometerRule rule_;
  MagneticReference reference_;
  std::optional<InertialLowPass> low_pass_;
  /// q_nb = q_ni q_ib: i turns with nothing but the gyros' integral, and the
  /// corrections move n to it.
  Eigen::Quaterniond q_ni_, q_ib_;
  Eigen::Matrix3d C_ib_;
  double t_;
  Eigen::Vector3d b_g_;
  Eigen::Vector3d s_g_;
  Eigen::Vector3d b_a_;
  double dip_;         ///< of the field [rad]
  int adoptions_ = 0;  ///< of the reference that dip_ is of
  Matrix P_;
  Vector dx_ = Vector::Zero();
  Eigen::Vector3d unscale_;  ///< 1 / (1 + s_g)
  AttitudeTransition transition_;
  std::vector<ScalarUpdate>* record_ = nullptr;
  Interval turned_;     ///< since the last Predict
  Interval predicted_;  ///< of the last Predict
  double rate_sigma_;   ///< of RestDetector::rate() at rest [rad/s]
  double dt_;           ///< between updates [s]
  BiasedForce force_ = BiasedForce::Zero();
  Eigen::Matrix3d C_if_ = Eigen::Matrix3d::Identity();  ///< from its axes to i
  double force_variance_ = 0.0;  ///< of force_, by the rule alone [m^2/s^4]
  FieldMean field_;
  double field_t_;  ///< of the last reading used [s]
  bool resting_ = false;
  AttitudeVerdict verdict_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_FILTER_H_
