#ifndef HINDSIGHT_DATASET_DATASET_H_
#define HINDSIGHT_DATASET_DATASET_H_

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "dataset/alignment_choice.h"
#include "dataset/known_constants.h"
#include "imu/imu_stream.h"
#include "measurements/measurement.h"
#include "measurements/sensor.h"
#include "state/state.h"

namespace hindsight {

/// One aiding sensor and its measurements, in time order.
struct AidingStream {
  Sensor sensor;
  MeasurementSeries measurements;
  /// Nothing is known of Sensor::time_offset: the data tell where its clock
  /// stands (dataset/clock_search.h).
  bool clock_unknown = false;
  /// Its stamps or the IMU's stand where the configuration places them (rows
  /// that are counted, a given start), and not as one clock told them: the time
  /// offset left is that of this recording alone.
  bool clock_placed = false;
};

/// A reference trajectory. Absent quantities are absent, not zero.
struct TruthPoint {
  double t = 0.0;
  std::optional<Eigen::Vector3d> p_e;
  std::optional<Eigen::Vector3d> v_n;      ///< NED [m/s]
  std::optional<Eigen::Quaterniond> q_nb;  ///< body to NED
  /// Whether the body moves, if the reference says so.
  std::optional<bool> moving;
  std::optional<Eigen::Vector3d> b_g;  ///< known of simulated data [rad/s]
  std::optional<Eigen::Vector3d> b_a;  ///< known of simulated data [m/s^2]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.t, z.p_e, z.v_n, z.q_nb, z.moving, z.b_g, z.b_a);
  }
};

using TruthSeries = PackedSeries<TruthPoint>;

/// How good the reference is itself; absent: without errors.
struct TruthSigma {
  std::optional<Eigen::Vector3d> position;  ///< NED [m]
  std::optional<Eigen::Vector3d> velocity;  ///< NED [m/s]
  std::optional<Eigen::Vector3d> attitude;  ///< roll, pitch, heading [rad]
};

/// Initial values. What is absent is found by alignment.
struct InitialState {
  AlignmentKind alignment = AlignmentKind::kAuto;
  std::optional<double> t;  ///< start here instead of the common start [s]
  std::optional<Geodetic> position;
  std::optional<Eigen::Vector3d> v_n;
  std::optional<Eigen::Vector3d> euler;  ///< roll, pitch, heading [rad]
  std::optional<double> heading;         ///< heading alone [rad]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> position_sigma;  ///< NED [m]
  std::optional<Eigen::Vector3d> velocity_sigma;  ///< NED [m/s]
  /// Sigma of each component of a velocity that nothing tells [m/s].
  double speed_spread = 10.0;
  std::optional<Eigen::Vector3d>
      attitude_sigma;  ///< roll, pitch, heading [rad]
  std::optional<Eigen::Vector3d> gyro_bias_sigma;   ///< [rad/s]
  std::optional<Eigen::Vector3d> accel_bias_sigma;  ///< [m/s^2]
};

/// Whether rest (dataset/rest.h) makes measurements, and when an IMU is quiet:
/// over `window`, the standard deviations of its readings are below thresholds.
struct StationaryOptions {
  bool enabled = false;
  double window = 1.0;            ///< [s]
  double gyro_threshold = 0.01;   ///< [rad/s], standard deviation
  double accel_threshold = 0.10;  ///< [m/s^2], standard deviation
  double velocity_sigma = 0.01;   ///< of the zero-velocity measurement [m/s]
  double rate_sigma = 5e-4;       ///< of the zero-rate measurement [rad/s]
};

/// How attitude alone is estimated. The defaults suit a sensor held in the hand
/// or worn.
struct AhrsSettings {
  /// Accelerometer rule: fixed, gate, held_gate, adaptive, smnc (see
  /// attitude/accelerometer_rule.h, as for the following).
  std::string rule = "fixed";
  double accel_sigma = 0.18;  ///< R0 [m/s^2]
  double gate = 0.88;         ///< [m/s^2]
  double lambda = 0.05;
  int samples = 4;                ///< N
  std::optional<double> seconds;  ///< N as a time [s]
  /// Time constant of the low-pass that the specific force goes through in axes
  /// that do not turn with the body [s]. 0: there is none. Absent: 1.5 s for
  /// the fixed rule, none for the rules that judge each reading themselves.
  std::optional<double> low_pass;
  /// Correlation time of the errors of accelerometer and magnetometer [s].
  double correlation_time = 1.0;
  /// Standard deviation of the gyro bias that one sample at rest shows [rad/s];
  /// 0: rest is not used.
  double rest_sigma = 0.0175;
  bool reject_disturbances = true;  ///< by norm and dip of the field
  /// The smoother surveys the field of the whole recording first.
  bool survey = true;
};

/// Measurements of one sensor type or name kept from the estimators.
struct Withholding {
  std::string sensor;   ///< stream name, or a type: "position", "velocity"...
  double every = 0.0;   ///< start to start [s]
  double length = 0.0;  ///< [s]
  /// First start, counted from the first fix of the stream [s]; default: every
  /// after the first that the IMU covers.
  std::optional<double> from;
};

/// An error added on purpose to a sensor's measurements.
struct Injection {
  enum class Kind { kStep, kPulse, kRamp, kSpikes, kMultipath };
  std::string sensor;  ///< stream name, or a type: "position", "velocity"...
  Kind kind = Kind::kStep;
  double size = 0.0;  ///< [m], or [m/s] if `speed`; of each axis that is hit
  double from = -std::numeric_limits<double>::infinity();  ///< [s]
  double to = std::numeric_limits<double>::infinity();     ///< exclusive [s]
  /// NED; absent: north and east, of a height up.
  std::optional<std::array<bool, 3>> axes;
  bool speed = false;  ///< the sensor measures velocities
  bool up = false;  ///< the sensor measures heights; ApplyInjections fills it
  double share = 0.1;  ///< of the measurements that a spike hits
  double tau = 20.0;   ///< of multipath [s]
};

/// An interval in which a sensor was withheld or measured nothing.
struct Outage {
  int sensor = 0;
  double t_begin = 0.0;
  double t_end = 0.0;
};

/// What a reader did under a declared policy (dropped duplicates, skipped
/// absent truth values...), counted for the report.
struct PolicyCount {
  std::string stream;
  std::string action;
  long count = 0;
};

/// A recording and all that is known about it, in SI units, body axes
/// forward-right-down, time in seconds since `epoch`.
struct Dataset {
  std::string name;
  /// Nanoseconds of GPS time since 1980-01-06 at t = 0; absent if the clock
  /// has no date.
  std::optional<std::int64_t> epoch_gps_ns;
  ImuStream imu;
  std::vector<AidingStream> streams;
  TruthSeries truth;
  /// Known of simulated data, by the name of the estimated constant, SI.
  std::map<std::string, double> true_constants;
  /// Point the truth speaks of, body axes from the IMU [m].
  Eigen::Vector3d truth_lever_arm_b = Eigen::Vector3d::Zero();
  TruthSigma truth_sigma;
  /// Of the stream whose positions are the truth, with the clock and at the
  /// lever arm that its sensor is configured with.
  std::optional<std::size_t> truth_stream;
  /// How well the vehicle's axes are known against the IMU's: standard deviations
  /// of a constant rotation about the body axes [rad]. It is not estimated; what
  /// is said of the vehicle's attitude counts it.
  Eigen::Vector3d mounting_sigma = Eigen::Vector3d::Zero();
  InitialState initial;
  /// What earlier recordings say of the constants, which UseConstants has put
  /// into the sensors but for the covariances of one with another.
  std::optional<KnownConstants> constants;
  /// Where attitude alone is estimated: gives gravity and the Earth's rate.
  std::optional<Geodetic> place;
  AhrsSettings ahrs;
  /// A priori standard deviations of the IMU's scale factors, per axis [1];
  /// absent: not estimated.
  std::optional<Eigen::Vector3d> gyro_scale_sigma;
  std::optional<Eigen::Vector3d> accel_scale_sigma;
  StationaryOptions stationary;
  std::vector<Withholding> withholdings;
  std::vector<Injection> injections;  ///< what ApplyInjections has added
  std::vector<Outage> outages;        ///< filled by ApplyWithholding
  /// Known of simulated data: in which a sensor measured nothing.
  std::vector<Outage> silences;
  double max_node_spacing = 1.0;  ///< [s]
  std::vector<PolicyCount> policies;
  std::vector<std::string> notes;  ///< what else was done to it, in words
};

/// Marks the measurements named by `withholdings` as withheld and lists the
/// outages; an outage cut by the end of the stream is left out. Throws
/// InputError if a name fits no stream.
void ApplyWithholding(Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_DATASET_H_
