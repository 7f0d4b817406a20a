#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_BLOCK_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_BLOCK_H_

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "measurements/measurement.h"
#include "measurements/sensor.h"
#include "state/error_layout.h"

namespace hindsight {

/// A noise value of a sensor that the data can tell, and its name behind the
/// sensor's.
struct NoiseValue {
  std::string_view name;
  double* (*at)(Sensor&);
};

/// A block of error states that a kind of sensor may bring into the layout.
struct SensorBlock {
  BlockKind kind = BlockKind::kScale;
  std::string_view name;  ///< behind the sensor's: "lever_arm"
  std::string_view unit;  ///< SI, "1" of a ratio
  /// A priori standard deviations of its axes; none: it is not estimated.
  /// `first` is the stream's first measurement, nullptr if it has none.
  std::optional<Eigen::Vector3d> (*sigma)(const Sensor&,
                                          const MeasurementModel* first);
  /// A priori value; nullptr: zero.
  Eigen::Vector3d (*value)(const Sensor&) = nullptr;
  /// nullptr: constant.
  Evolution (*evolution)(const Sensor&) = nullptr;
  /// The motion that makes a weak constant visible.
  std::string_view advice = {};
  /// Makes what another recording says of it the a priori value and standard
  /// deviations; nullptr: what holds in one recording does not in the next.
  void (*know)(const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
               Sensor*) = nullptr;
  /// Values that `check --noise` looks for: those that `sigma` and `evolution`
  /// follow from, and what is white beside the block; nullptr: none.
  std::vector<NoiseValue> (*searched)(const Sensor&) = nullptr;
};

/// The same standard deviation on all axes, if there is one.
std::optional<Eigen::Vector3d> OnAllAxes(const std::optional<double>& sigma);

/// Blocks that several kinds have.
SensorBlock ScaleBlock();
SensorBlock MountingBlock();
SensorBlock LeverArmBlock();
SensorBlock TimeOffsetBlock();
/// The error of a correlated NoiseModel, as kColouredNoise or kOffset.
SensorBlock NoiseBlock(BlockKind kind, std::string_view unit);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_BLOCK_H_
