#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_KEY_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_KEY_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <variant>
#include <vector>

#include "base/quantity.h"
#include "measurements/measurement.h"

namespace hindsight {

/// What only a simulation knows of a sensor.
struct SimulatedTruth {
  Eigen::Vector3d current_n = Eigen::Vector3d::Zero();  ///< NED [m/s]
  double beam_dropout = 0.0;  ///< probability that a ping loses a beam
  double scale = 0.0;         ///< k: measured = (1 + k) true
  double offset = 0.0;        ///< added to a height [m]
};

/// What a configuration says of one stream but for its file.
struct SensorSettings {
  Sensor sensor;
  /// A measurement without its values: form, sigmas, what is constant.
  MeasurementModel pattern;
  /// Replaces the file's standard deviations: NED, forward-right-down, or the
  /// same thrice where there is one.
  std::optional<Eigen::Vector3d> sigma;
  double sigma_scale = 1.0;      ///< multiplies the file's
  bool use_correlations = true;  ///< of the file
  std::set<int> accept_quality;  ///< values of the column quality; empty: all
  double every = 0.0;            ///< use one measurement in this time [s]
  /// Sensor axes to body axes, of a sensor without a mounting to estimate.
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();
  /// Of a kind that has no file, and of a simulated one [Hz].
  double rate_hz = 1.0;
  /// Standard deviation of the vehicle's mean roll about zero [rad].
  std::optional<double> level_sigma;
  SimulatedTruth truth;
};

/// The pattern of settings whose kind has measurements of type Model.
template <class Model>
Model& PatternOf(SensorSettings& settings) {
  return std::get<Model>(settings.pattern);
}
template <class Model>
const Model& PatternOf(const SensorSettings& settings) {
  return std::get<Model>(settings.pattern);
}

/// One key of a sensor: how it is written, which values it may have, and where
/// its value stands in the settings. The default is what stands there before
/// anything is read; one outside the range is none. A name may have one dot,
/// "current.sigma": a key of a map, whose first key must be given where the map
/// is, but for those of `estimate`.
struct SensorKey {
  enum class Range {
    kAny,
    kPositive,
    kNotNegative,
    kScale,  ///< above -1: measured = (1 + scale) true
  };

  struct Number {
    double* (*at)(SensorSettings&);
    Range range = Range::kAny;
  };
  /// Absent is a value of its own.
  struct OptionalNumber {
    std::optional<double>* (*at)(SensorSettings&);
    Range range = Range::kPositive;
  };
  /// Three values.
  struct Vector {
    Eigen::Vector3d* (*at)(SensorSettings&);
  };
  /// Standard deviations greater than zero, three or one for all; or one alone.
  struct OptionalSigmas {
    std::optional<Eigen::Vector3d>* (*at)(SensorSettings&);
    bool one = false;
  };
  /// Two standard deviations greater than zero, [side, down], behind a first
  /// that does not count.
  struct SidesSigma {
    std::optional<Eigen::Vector3d>* (*at)(SensorSettings&);
  };
  /// Roll, pitch, yaw of the sensor's axes; or `unknown`, where it is allowed.
  struct Mounting {
    bool may_be_unknown = false;
  };
  /// `axes` and `mounting` of SensorSettings::C_bs.
  struct Axes {};
  /// Latitude, longitude and height, kept in ECEF [m].
  struct Place {
    Eigen::Vector3d* (*at)(SensorSettings&);
  };
  /// A whole number within bounds, without a unit.
  struct Whole {
    double* (*at)(SensorSettings&);
    int least = 0;
    int most = 0;
  };
  struct Word {
    std::vector<std::string_view> words;
    std::size_t (*get)(const SensorSettings&);
    void (*set)(SensorSettings&, std::size_t);
  };
  using Value = std::variant<Number, OptionalNumber, Vector, OptionalSigmas,
                             SidesSigma, Mounting, Axes, Place, Whole, Word>;

  std::string_view name;
  Quantity quantity = Quantity::kRatio;
  Value value;
  std::string_view help;
  /// Whether the sensor has the key, by what stands before it; nullptr: always.
  bool (*applies)(const SensorSettings&) = nullptr;
  std::string_view when = {};  ///< the same in words, "form: beams"
  /// Whether the key must be given; nullptr: never.
  bool (*needed)(const SensorSettings&) = nullptr;
  /// What is said where it is missing.
  std::string_view missing = "is missing";
  bool simulated = false;  ///< a key of scenarios alone
};

using SensorKeys = std::vector<SensorKey>;

inline bool Always(const SensorSettings&) { return true; }

/// What a value contradicts.
struct KeyObjection {
  std::string_view key;
  std::string_view text;
};

/// Keys that several kinds have.
SensorKey LeverArmKey();
SensorKey LeverArmSigmaKey();
SensorKey MountingKey(bool may_be_unknown = false);
SensorKey MountingSigmaKey();
SensorKey ScaleKey();
SensorKey ScaleSigmaKey();
/// `sigma`, into SensorSettings::sigma.
SensorKey SigmaKey(Quantity quantity, bool one, std::string_view help);
SensorKey NeededSigmaKey(Quantity quantity, std::string_view help);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_KEY_H_
