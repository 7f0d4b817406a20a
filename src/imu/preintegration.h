#ifndef HINDSIGHT_IMU_PREINTEGRATION_H_
#define HINDSIGHT_IMU_PREINTEGRATION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstddef>
#include <vector>

#include "imu/imu_stream.h"
#include "imu/kinematics.h"
#include "imu/sample_integral.h"

namespace hindsight {

/// Errors of the IMU at which the samples are integrated:
/// measured = (1 + scale) true + bias + noise, per body axis.
struct ImuCalibration {
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d s_g = Eigen::Vector3d::Zero();  ///< [1]
  Eigen::Vector3d s_a = Eigen::Vector3d::Zero();  ///< [1]
};

/// All that the samples of one interval [t_i, t_j] say about motion, in the
/// inertial axes that coincide with the body axes at t_i:
///   dR = C(t_i <- t_j),  dv = int C f,  dp = int int C f.
/// Independent of position, velocity and the Earth's rotation. The Jacobians
/// give the change of the mean with (true - used) calibration error d:
///   dR -> Exp(R_bg d) dR,   dv -> dv + v_bg d_bg + v_ba d_ba,  dp likewise.
/// Errors e = (e_p, e_v, e_R): e_R on the right of dR (body axes at t_j).
struct ImuSummary {
  double t_i = 0.0;
  double t_j = 0.0;
  ImuCalibration calibration;
  Eigen::Quaterniond dR = Eigen::Quaterniond::Identity();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();
  Eigen::Vector3d dp = Eigen::Vector3d::Zero();

  Eigen::Matrix3d R_bg, v_bg, p_bg, v_ba, p_ba;
  /// With respect to scale factors; filled only if asked for.
  Eigen::Matrix3d R_sg, v_sg, p_sg, v_sa, p_sa;

  /// Covariance of e from white noise and from the biases' own noise within
  /// the interval.
  Eigen::Matrix<double, 9, 9> noise;
  /// Covariance of e with the noise that the gyro (columns 0-2) and
  /// accelerometer biases (3-5) have accumulated at t_j.
  Eigen::Matrix<double, 9, 6> bias_cross;
  double gyro_bias_variance = 0.0;  ///< accumulated over the interval, an axis
  double accel_bias_variance = 0.0;
  double gyro_bias_phi = 1.0;  ///< exp(-dt/tau)
  double accel_bias_phi = 1.0;

  double dt() const { return t_j - t_i; }
};

/// A summary of an interval of no length at t, to which
/// ImuIntegrator::AppendMean adds. Its mean alone is kept up; Jacobians and
/// noise stay zero.
ImuSummary EmptyMean(double t, const ImuCalibration& calibration);

/// Mean of a summary moved to another calibration, to first order.
struct CorrectedMean {
  Eigen::Quaterniond dR;
  Eigen::Vector3d dv;
  Eigen::Vector3d dp;
  Eigen::Vector3d rotation_correction;  ///< R_bg d_bg + R_sg d_sg [rad]
};
CorrectedMean Correct(const ImuSummary& summary, const ImuCalibration& at);

/// True if `at` is so far from the summary's calibration that second-order
/// terms matter: rotation correction above 1 mrad, or scale above 1e-3 times
/// the motion.
bool NeedsReintegration(const ImuSummary& summary, const ImuCalibration& at);

/// Rates with the errors of a calibration taken out, (raw - bias)/(1 + scale).
template <typename Real>
LinearRatesOf<Real> Calibrated(const LinearRatesOf<Real>& raw,
                               const ImuCalibration& calibration);

/// White noise of one sample interval on top of the IMU's own.
struct IntervalNoise {
  double gyro = 0.0;   ///< squared density [rad^2/s]
  double accel = 0.0;  ///< squared density [m^2/s^3]
};

/// Accumulates sample intervals into a summary. Mean to second order per
/// sample; Jacobians and noise by moments, exact in the limit of small samples
/// and cheaper than propagating a covariance (one pass of sums, assembled once
/// in Finish). No allocation. Of one interval (Real = double), or of two at once that
/// have as many samples (Pair).
template <typename Real>
class PreintegratorOf {
 public:
  PreintegratorOf(const ImuNoise& noise, bool with_scale_jacobians);

  /// Starts a new interval.
  void Start(const Real& t_i, const ImuCalibration& calibration);
  /// Appends the next sample interval, calibration errors not yet removed.
  /// `extra` is noise of this interval on top of the IMU's own.
  void Add(const LinearRatesOf<Real>& raw, const IntervalNoise& extra = {});
  /// The summary from the start to the end of the last sample added; of a pair, of
  /// interval `lane`, 0 or 1.
  ImuSummary Finish(int lane = 0) const;

 private:
  template <typename>
  friend class PreintegratorOf;
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  using Matrix3 = Eigen::Matrix<Real, 3, 3>;

  struct Snapshot {
    Real s = 0.0;
    Vector3 v, p;
    Matrix3 S_g, V_g, P_g, S_a, P_a;
  };
  static constexpr int kMaxSnapshots = 16;

  void TakeSnapshot();
  void AddScaleJacobians(const Matrix3& C_mid, const LinearRatesOf<Real>& r,
                         const Vector3& dv_i);
  PreintegratorOf<double> Lane(int lane) const;
  ImuSummary Summary() const requires std::same_as<Real, double>;
  void AssembleWhiteNoise(
      ImuSummary* out) const requires std::same_as<Real, double>;
  void AssembleBiasNoise(
      ImuSummary* out) const requires std::same_as<Real, double>;

  ImuNoise noise_;
  bool with_scale_;
  bool has_bias_noise_;
  bool gauss_markov_;
  ImuCalibration calibration_;
  Real t_i_ = 0.0;
  Real T_ = 0.0;
  Eigen::Quaternion<Real> q_;
  Matrix3 C_;
  Vector3 v_, p_;
  // Integrals of the attitude, weighted by the bias decay: S = int C, V_g =
  // int [f x] S, P = int of V or S.
  Matrix3 S_g_, V_g_, P_g_, S_a_, P_a_;
  Matrix3 U_g_, VU_g_, PU_g_, U_a_, PU_a_;
  // Moments over the gyro noise variance rate q: sums of q ds times products of
  // v(s) and u(s) = p(s) - s v(s).
  Real q_sum_ = 0.0;
  // The same of the accelerometer: sums of q ds times powers of s.
  Real a_sum_ = 0.0, as_ = 0.0, ass_ = 0.0;
  Vector3 qv_, qu_;
  Matrix3 qvv_, qvu_, quu_;
  std::array<Snapshot, kMaxSnapshots> snapshots_;
  int snapshot_count_ = 0;
  int snapshot_every_ = 1;
  int samples_since_snapshot_ = 0;
};
using Preintegrator = PreintegratorOf<double>;

/// Noise of a bridged drop-out: over its whole length the true rate may be off
/// the straight line between the readings at its ends by max(0.1 rad/s, their
/// difference), the specific force by max(1 m/s^2, their difference), one
/// sigma, constant over the drop-out.
IntervalNoise BridgeNoise(const LinearRates& rates);

/// Turns intervals of a stream into summaries. Splits a sample where an
/// interval begins or ends inside it.
class ImuIntegrator {
 public:
  explicit ImuIntegrator(const ImuStream& stream,
                         bool with_scale_jacobians = false)
      : stream_(&stream),
        with_scale_jacobians_(with_scale_jacobians),
        integrator_(stream.noise, with_scale_jacobians) {}

  /// Summary of [t_i, t_j], which must lie inside the stream's span. Calls in
  /// time order cost time in proportion to the samples of the interval.
  ImuSummary Summarize(double t_i, double t_j,
                       const ImuCalibration& calibration);
  /// Summaries of the intervals between three times, in less time than one by one;
  /// the same but for rounding.
  std::array<ImuSummary, 2> SummarizePair(const std::array<double, 3>& times,
                                          const ImuCalibration& calibration);

  /// Appends [mean->t_j, t_j] to what began as EmptyMean, at its calibration.
  void AppendMean(double t_j, ImuSummary* mean);

  /// dR of the same alone, at a fraction of the cost; `b_g` is subtracted.
  Eigen::Quaterniond Turn(double t_i, double t_j, const Eigen::Vector3d& b_g);

  /// Reading at t, linear between samples.
  Kinematics ReadingAt(double t);

  /// Rates over the sample interval that ends at sample k >= 1.
  LinearRates RatesOfInterval(std::size_t k) const;

  /// What a smooth course through readings of rates has in the mean over that
  /// interval more than the line between its ends. With the second differences
  /// D of the readings about both ends
  ///   -dt^2 / 12 (D_{k-1} + D_k) / 2,
  /// of evenly spaced ones (w_{k-1} + w_k - w_{k-2} - w_{k+1}) / 24: integrals
  /// are then right to fourth order, where the line's miss (omega dt)^2 / 12 of a
  /// swing. At an end of the recording, and beside a drop-out or an interval less
  /// than half as long, the other D stands for both. Zero for increments, which
  /// are integrals, and across a drop-out.
  Kinematics BendOfInterval(std::size_t k) const;

 private:
  /// Calls `use` for every sample interval within [t_i, t_j] with its rates;
  /// the second argument is the whole interval where it bridges a drop-out,
  /// else nullptr.
  template <typename Use>
  void Walk(double t_i, double t_j, const Use& use);
  bool IsDropOut(std::size_t k) const;
  /// From sample a to b; `previous` is the one before a, if there is one.
  LinearRates RatesBetween(const ImuSample* previous, const ImuSample& a,
                           const ImuSample& b) const;

  /// Smallest k >= 1 with samples[k].t > t (or the last).
  std::size_t FindInterval(double t);

  const ImuStream* stream_;
  bool with_scale_jacobians_;
  Preintegrator integrator_;
  /// Of a pair of intervals; kept for the next.
  std::array<std::vector<LinearRates>, 2> pair_rates_;
  std::size_t hint_ = 1;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_PREINTEGRATION_H_
