#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_KIND_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_KIND_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/quantity.h"
#include "base/random.h"
#include "base/units.h"
#include "measurements/sensor_block.h"
#include "measurements/sensor_key.h"
#include "state/motion.h"

namespace hindsight {

/// The columns of a file that hold what is measured, and how many standard
/// deviations, in the order of the values, come behind them.
struct MeasuredColumns {
  std::size_t first = 0;
  std::size_t count = 1;
  std::size_t sigmas = 0;
};

/// One row of a file, its values in the order of SensorKind::columns.
class MeasuredRow {
 public:
  virtual ~MeasuredRow() = default;
  virtual double Value(std::size_t column) const = 0;  ///< SI
  virtual bool Has(std::size_t column) const = 0;
  /// A column of 1 and 0.
  virtual bool Flag(std::size_t column) const = 0;
  /// Of a measured value, from the row or the settings.
  virtual double Sigma(std::size_t axis) const = 0;
  /// Of three measured values, with what correlates them.
  virtual Eigen::Matrix3d Covariance() const = 0;
  /// Throws InputError that names file and line.
  [[noreturn]] virtual void Fail(const std::string& message) const = 0;
};

/// A column as a simulated recording has it.
struct WrittenColumn {
  const char* name;
  const char* unit;
  double si = 1.0;  ///< one such unit in SI
  /// Decimals if positive, significant digits if negative, 0: as many as read
  /// back the same.
  int digits = 0;
};

/// A kind of aiding sensor, all of it: whatever reads, writes, simulates,
/// withholds or documents sensors walks the list of them (SensorKinds).
struct SensorKind {
  std::string_view name;  ///< `type` in configurations, word of --withhold
  std::string_view help;  ///< one line
  /// A second word by which measurements are withheld, of a variant.
  std::string_view family = {};
  /// A configuration may have it; else the program makes it itself.
  bool configured = true;
  /// Without a file: the pattern at SensorSettings::rate_hz.
  bool generated = false;

  /// Names of a residual's components, if every measurement has all of them;
  /// north, east, down of a vector in those axes.
  std::vector<std::string_view> components = {};
  std::string_view residual_unit = {};  ///< SI; empty where components differ
  bool is_position = false;  ///< a PositionFix, of a geodetic position
  bool is_velocity = false;  ///< a VelocityFix
  bool is_height = false;    ///< a HeightFix
  bool places = false;       ///< tells where the vehicle is, not only how high
  bool moves = false;        ///< tells the velocity over the ground
  bool of_vehicle = false;   ///< speaks of the axes of a vehicle on its wheels
  bool in_vehicle_axes = false;  ///< tells a velocity in axes of the vehicle
  bool magnetic = false;
  bool is_heading = false;  ///< a GenericReading of BaselineDirection()
  bool standing = false;    ///< says that the vehicle stands
  bool is_prior = false;    ///< said beforehand: no noise is fitted to it
  /// Its stamps may be shifted, and the shift be estimated.
  bool has_clock = true;
  /// Its errors may be a Gauss-Markov process of this quantity.
  std::optional<Quantity> coloured = {};
  /// Its file states standard deviations unless `sigma` replaces them.
  bool states_sigma = false;

  /// Quantities that its file may hold. Names behind the measured values:
  /// standard deviations, then covariances as signed square roots (sd_ne
  /// |sd_ne| = cov(n, e)), then quality, then others.
  std::vector<FieldName> columns = {};
  MeasuredColumns (*measured)(const SensorSettings&) = nullptr;
  /// Columns behind the measured ones may be empty in a row.
  bool has_optional_columns = false;
  /// Absent measured values are the kind's own to judge, in `read`.
  bool (*judges_absence)(const SensorSettings&) = nullptr;
  /// Columns that contradict the settings, and why.
  struct Forbidden {
    std::size_t first = 0;
    std::size_t count = 0;
    std::string_view reason = {};
  };
  Forbidden (*forbidden)(const SensorSettings&) = nullptr;

  SensorKeys keys = {};
  /// Error states that it may bring, in the order of the layout.
  std::vector<SensorBlock> blocks = {};
  /// Pattern and defaults, before keys are read.
  void (*prepare)(SensorSettings*) = nullptr;
  /// After all keys: what follows from them; an objection to what was read.
  std::optional<KeyObjection> (*complete)(SensorSettings*) = nullptr;

  /// From a pattern back to what the keys say: its sigmas into
  /// SensorSettings::sigma; nullptr: there is nothing to do.
  void (*uncomplete)(SensorSettings*) = nullptr;

  /// The measurement of a row; none where it has nothing to say, which is
  /// counted as `unread`.
  std::optional<MeasurementModel> (*read)(const MeasuredRow&,
                                          const SensorSettings&) = nullptr;
  std::string_view unread = "row without a measurement";
  /// What is to be done to the rows together, and its inverse.
  void (*join)(const SensorSettings&, MeasurementSeries*) = nullptr;
  MeasurementSeries (*split)(const MeasurementSeries&) = nullptr;

  /// The file of a simulated recording: columns after t, and their values.
  std::vector<WrittenColumn> (*written)(const MeasurementModel&,
                                        const Sensor&) = nullptr;
  std::vector<double> (*write)(const MeasurementModel&,
                               const Sensor&) = nullptr;

  /// What a perfect sensor says: written apart from the model of the
  /// estimators, so that each can be held against the other. None where it
  /// would have nothing to say.
  std::optional<MeasurementModel> (*perfect)(const SensorSettings&,
                                             const Motion&) = nullptr;
  /// Of a sensor that counts: the rate of the count, which the simulation
  /// integrates from one to the next, and where it puts the integral.
  bool (*counts)(const SensorSettings&) = nullptr;
  void (*set_count)(double t_from, double count, MeasurementModel*) = nullptr;
  double (*count_rate)(const SensorSettings&, const Motion&) = nullptr;
  /// Adds the lasting errors of a velocity to a perfect measurement: its own
  /// and, of one over the ground, that of the ground, both in the sensor's axes.
  void (*add_lasting)(const Eigen::Vector3d& bias_s,
                      const Eigen::Vector3d& ground_bias_s,
                      MeasurementModel*) = nullptr;
  /// Adds errors as the settings and their SimulatedTruth say, to measurements
  /// in time order.
  void (*disturb)(const SensorSettings&, Random*,
                  std::vector<Measurement>*) = nullptr;
};

/// The list of all kinds, in the order of documentation.
const std::vector<const SensorKind*>& SensorKinds();

/// By name; nullptr if there is none.
const SensorKind* FindSensorKind(std::string_view name);

/// Adds a kind that a program brings; it must outlive the use of the list.
/// Throws std::invalid_argument if the name is taken.
void AddSensorKind(const SensorKind& kind);

/// Of a mounting that the data give a first value [rad].
inline constexpr double kFoundMountingSigma = 10.0 * kDegree;

/// The sensor, and a pattern of its kind.
SensorSettings SettingsOf(const SensorKind& kind);

/// The sigmas of a covariance without correlations, which a written file
/// states. Throws InputError if there are any.
Eigen::Vector3d UncorrelatedSigma(const Eigen::Matrix3d& R);

/// Velocity of the sensor's point in the sensor's axes, of a perfect sensor.
Eigen::Vector3d PerfectVelocity(const Sensor& sensor, const Motion& motion);

/// Kinds that the program makes itself, or that its scenarios name.
const SensorKind& VelocityKind();
const SensorKind& HeightKind();
const SensorKind& DepthKind();
const SensorKind& ZeroVelocityKind();
const SensorKind& ZeroAngularRateKind();
const SensorKind& OdometerKind();
const SensorKind& NonHolonomicKind();
const SensorKind& SpeedCourseKind();
const SensorKind& VehicleLevelKind();
const SensorKind& TiltKind();
const SensorKind& DvlKind();
const SensorKind& AcousticKind();
const SensorKind& MagnetometerKind();

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_KIND_H_
