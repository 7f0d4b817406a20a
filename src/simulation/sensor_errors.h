#ifndef HINDSIGHT_SIMULATION_SENSOR_ERRORS_H_
#define HINDSIGHT_SIMULATION_SENSOR_ERRORS_H_

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "dataset/dataset.h"
#include "measurements/sensor_kind.h"
#include "simulation/trajectory.h"

namespace hindsight {

/// Errors of a simulated IMU: measured = (1 + scale) true + bias + noise.
struct ImuErrorModel {
  /// White noise, and bias walk or Gauss-Markov bias from the start value on.
  ImuNoise noise;
  /// Start value of the biases: `bias` plus a normal deviate of `sigma`.
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();         ///< [rad/s]
  Eigen::Vector3d gyro_bias_sigma = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();        ///< [m/s^2]
  Eigen::Vector3d accel_bias_sigma = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();        ///< [1] per axis
  Eigen::Vector3d accel_scale = Eigen::Vector3d::Zero();       ///< [1] per axis
  /// Normal deviates added to the scale factors, drawn per seed; if not zero,
  /// the data set says so as its a priori sigmas.
  Eigen::Vector3d gyro_scale_sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_scale_sigma = Eigen::Vector3d::Zero();
};

/// Turns perfect samples into measured ones, in time order. Gyro noise, gyro
/// bias, accelerometer noise and accelerometer bias are independent streams of
/// the seed: changing one leaves the others' deviates alone.
class ImuErrors {
 public:
  ImuErrors(const ImuErrorModel& model, ImuStream::Kind kind, double rate_hz,
            std::uint64_t seed);

  /// Biases at the stamp of the sample last given (at first: the start values).
  const Eigen::Vector3d& gyro_bias() const { return gyro_.bias; }
  const Eigen::Vector3d& accel_bias() const { return accel_.bias; }
  /// The scale factors of the seed.
  Eigen::Vector3d gyro_scale() const { return gyro_.scale_factor.array() - 1; }
  Eigen::Vector3d accel_scale() const {
    return accel_.scale_factor.array() - 1;
  }

  void Apply(ImuSample* sample);

 private:
  struct Channel {
    Eigen::Vector3d bias;
    Eigen::Vector3d scale_factor;  ///< 1 + s
    double phi = 1.0;              ///< of the bias over one sample
    double walk_sigma = 0.0;       ///< of the bias over one sample
    /// Of its white noise at this rate or specific force.
    double (*density)(const ImuNoise& noise, double magnitude);
    Random noise;
    Random walk;
  };
  Eigen::Vector3d Measure(const Eigen::Vector3d& truth, Channel* channel) const;

  ImuStream::Kind kind_;
  double dt_;
  ImuNoise noise_;
  bool first_ = true;
  Channel gyro_;
  Channel accel_;
};

/// Half-open span of time [s].
struct TimeSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// An aiding sensor to simulate. `sensor` is what is true of it and what the
/// data set says, `truth` what only the simulation knows; a priori sigmas of
/// its scale and offset are also those from which the true ones are drawn.
/// `sigma` is that of the noise, as SensorKind::complete takes it.
struct AidingModel : SensorSettings {
  explicit AidingModel(const SensorKind& kind = PositionKind())
      : SensorSettings(SettingsOf(kind)) {
    sigma = Eigen::Vector3d::Ones();
  }

  /// Measures each time that so much of the path is behind [m], in place of a
  /// rate; the stamps are rounded to microseconds.
  std::optional<double> spacing;
  double from = -std::numeric_limits<double>::infinity();  ///< first stamp [s]
  double to = std::numeric_limits<double>::infinity();     ///< last stamp [s]
  std::vector<TimeSpan> outages;  ///< stamps in them are missing
  /// The data set's lever arm, mounting and time offset are not the true ones:
  /// the true ones are off by normal deviates of their a priori sigmas.
  bool draw_calibration = false;
};

/// Perfect measurements of `model` with their covariances: what the sensor's
/// point (lever arm) does at stamp + time_offset, for stamps k/rate, or at
/// whole multiples of the spacing, that lie in the span of the motion. `q_nb`,
/// if there is one, gets the attitude (body to NED) at each, of a kind with
/// lasting errors.
std::vector<Measurement> PerfectMeasurements(
    const AidingModel& model, int sensor, Trajectory* trajectory, double t_end,
    std::vector<Eigen::Quaterniond>* q_nb = nullptr);

/// The scale error k of one seed: measured = (1 + k) true.
double DrawScale(const AidingModel& model, std::uint64_t seed);
/// The additive error of a height in one seed [m].
double DrawOffset(const AidingModel& model, std::uint64_t seed);

/// The sensor as the data set of one seed has it, and what its constants truly
/// are, by the names that the estimators give them.
struct DrawnSensor {
  Sensor sensor;
  std::map<std::string, double> true_constants;
};
DrawnSensor DrawSensor(const AidingModel& model, std::uint64_t seed);

/// Adds normal errors of the model's sigma, DrawScale and DrawOffset, and
/// before these the lasting errors of its velocities, drawn from their a priori
/// sigmas. The deviates come from a stream of the seed that belongs to the
/// sensor's name, so that adding a sensor changes no other one's errors. `q_nb`
/// as of PerfectMeasurements.
void AddMeasurementErrors(const AidingModel& model, std::uint64_t seed,
                          const std::vector<Eigen::Quaterniond>& q_nb,
                          std::vector<Measurement>* measurements);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_SENSOR_ERRORS_H_
