#include "alignment/start_layout.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

void AddCalibration(BlockKind kind, int sensor, const std::string& name,
                    const char* unit, const Eigen::Vector3d& sigma,
                    std::vector<Block>* blocks) {
  Block block;
  block.key = {kind, sensor};
  block.name = name;
  block.unit = unit;
  block.evolution = Evolution::Constant();
  block.sigma0 = sigma;
  blocks->push_back(block);
}

void AddMagneticBlocks(const Sensor& sensor, int index,
                       std::vector<Block>* blocks) {
  const MagneticSurroundings& magnetic = sensor.magnetic;
  if (magnetic.hard_iron_sigma) {
    AddCalibration(BlockKind::kHardIron, index, sensor.name + "_hard_iron",
                   "uT", *magnetic.hard_iron_sigma, blocks);
  }
  if (magnetic.declination_sigma) {
    AddCalibration(
        BlockKind::kDeclination, index, sensor.name + "_declination", "rad",
        Eigen::Vector3d::Constant(*magnetic.declination_sigma), blocks);
  }
  if (magnetic.disturbance_sigma) {
    Block block;
    block.key = {BlockKind::kDisturbance, index};
    block.name = sensor.name + "_disturbance";
    block.unit = "uT";
    block.sigma0.setConstant(*magnetic.disturbance_sigma);
    block.evolution = Evolution::GaussMarkov(*magnetic.disturbance_sigma,
                                             magnetic.disturbance_tau);
    blocks->push_back(block);
  }
}

bool CountsDistance(const AidingStream& stream) {
  if (stream.measurements.empty()) return false;
  const Measurement first = stream.measurements.front();
  const auto* odometer = std::get_if<Odometer>(&first.model);
  return odometer != nullptr && odometer->form == Odometer::Form::kIncrements;
}

/// The travelled distance, and the error of each count if it is an error of its
/// own: white, which is a correlation time below any interval.
void AddDistance(const Sensor& sensor, int index, std::vector<Block>* blocks) {
  constexpr double kAnyDistance = 1.0;  // it is forgotten at the first count
  constexpr double kNoTime = 1e-6;
  Block block;
  block.key = {BlockKind::kDistance, index};
  block.name = sensor.name + "_distance";
  block.unit = "m";
  block.evolution = Evolution::Navigation();
  block.sigma0.setConstant(kAnyDistance);
  blocks->push_back(block);
  if (sensor.count_sigma <= 0.0) return;
  block.key.kind = BlockKind::kOffset;
  block.name = sensor.name + "_count_error";
  block.evolution = Evolution::GaussMarkov(sensor.count_sigma, kNoTime);
  block.sigma0.setConstant(sensor.count_sigma);
  blocks->push_back(block);
}

/// The errors that a sensor's noise model keeps as states.
void AddColouredNoise(const Sensor& sensor, int index,
                      std::vector<Block>* blocks) {
  if (sensor.noise.kind != NoiseModel::Kind::kGaussMarkov) return;
  Block block;
  block.key = {sensor.type == SensorType::kHeight ? BlockKind::kOffset
                                                  : BlockKind::kColouredNoise,
               index};
  block.name = sensor.name + "_noise";
  block.unit = sensor.type == SensorType::kVelocity ? "m/s" : "m";
  block.evolution =
      Evolution::GaussMarkov(sensor.noise.sigma, sensor.noise.tau);
  block.sigma0.setConstant(sensor.noise.sigma);
  blocks->push_back(block);
}

void AddCurrent(const Sensor& sensor, int index, std::vector<Block>* blocks) {
  Block block;
  block.key = {BlockKind::kCurrent, index};
  block.name = sensor.name + "_current";
  block.unit = "m/s";
  const double sigma = *sensor.current_sigma;
  block.sigma0.setConstant(sigma);
  if (std::isfinite(sensor.current_length)) {
    block.evolution =
        Evolution::SpatialGaussMarkov(sigma, sensor.current_length);
  } else if (std::isfinite(sensor.current_tau)) {
    block.evolution = Evolution::GaussMarkov(sigma, sensor.current_tau);
  } else {
    block.evolution = Evolution::Constant();
  }
  blocks->push_back(block);
}

/// Every block beyond the navigation state, in the order of the layout.
std::vector<Block> CalibrationBlocks(const Dataset& dataset) {
  std::vector<Block> blocks;
  const int none = BlockKey::kNoSensor;
  if (dataset.gyro_scale_sigma) {
    AddCalibration(BlockKind::kGyroScale, none, "gyro_scale", "1",
                   *dataset.gyro_scale_sigma, &blocks);
  }
  if (dataset.accel_scale_sigma) {
    AddCalibration(BlockKind::kAccelScale, none, "accel_scale", "1",
                   *dataset.accel_scale_sigma, &blocks);
  }
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    const Sensor& sensor = dataset.streams[i].sensor;
    const int index = static_cast<int>(i);
    if (sensor.scale_sigma) {
      AddCalibration(BlockKind::kScale, index, sensor.name + "_scale", "1",
                     Eigen::Vector3d::Constant(*sensor.scale_sigma), &blocks);
    }
    if (sensor.mounting_sigma) {
      AddCalibration(BlockKind::kMounting, index, sensor.name + "_mounting",
                     "rad", *sensor.mounting_sigma, &blocks);
    }
    if (sensor.lever_arm_sigma) {
      AddCalibration(BlockKind::kLeverArm, index, sensor.name + "_lever_arm",
                     "m", *sensor.lever_arm_sigma, &blocks);
    }
    if (CountsDistance(dataset.streams[i])) {
      AddDistance(sensor, index, &blocks);
    }
    if (sensor.time_offset_sigma) {
      AddCalibration(
          BlockKind::kTimeOffset, index, sensor.name + "_time_offset", "s",
          Eigen::Vector3d::Constant(*sensor.time_offset_sigma), &blocks);
    }
    AddMagneticBlocks(sensor, index, &blocks);
    AddColouredNoise(sensor, index, &blocks);
    if (sensor.offset_sigma) {
      AddCalibration(BlockKind::kOffset, index, sensor.name + "_offset", "m",
                     Eigen::Vector3d::Constant(*sensor.offset_sigma), &blocks);
    }
    if (sensor.current_sigma) AddCurrent(sensor, index, &blocks);
  }
  return blocks;
}

}  // namespace

ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior) {
  ErrorLayout layout = NavigationLayout(prior);
  for (Block& block : CalibrationBlocks(dataset)) layout.Add(std::move(block));
  return layout;
}

void RequireCapacity(const Dataset& dataset, const std::string& config) {
  std::map<int, int> counts;
  int total = 0;
  for (const Block& block : CalibrationBlocks(dataset)) {
    const int count = FullDimension(block.key.kind);
    counts[block.key.sensor] += count;
    total += count;
  }
  if (total <= kMaxParameters) return;
  std::string parts;
  for (const auto& [sensor, count] : counts) {
    const std::string key =
        sensor == BlockKey::kNoSensor
            ? "imu.estimate"
            : "aiding." +
                  dataset.streams[static_cast<std::size_t>(sensor)].sensor.name;
    parts += ", " + key + " " + std::to_string(count);
  }
  throw InputError(config, 0,
                   std::to_string(total) +
                       " values to estimate beside position, velocity, "
                       "attitude and biases; expected at most " +
                       std::to_string(kMaxParameters) + ": " + parts.substr(2));
}

ParameterVector InitialParameters(
    const Dataset& dataset, const ErrorLayout& layout,
    const std::optional<Eigen::Vector3d>& travel_b) {
  constexpr double kRoughlyKnown = 20.0 * kDegree;
  ParameterVector parameters = ParameterVector::Zero(layout.parameter_count());
  for (const Block& block : layout.blocks()) {
    if (block.key.sensor == BlockKey::kNoSensor) continue;
    const Sensor& sensor =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)].sensor;
    const int offset = block.parameter_offset;
    if (block.key.kind == BlockKind::kLeverArm) {
      parameters.segment<3>(offset) = sensor.lever_arm_b;
    } else if (block.key.kind == BlockKind::kTimeOffset) {
      parameters(offset) = sensor.time_offset;
    } else if (block.key.kind == BlockKind::kScale) {
      parameters(offset) = sensor.scale;
    } else if (block.key.kind == BlockKind::kHardIron) {
      parameters.segment<3>(offset) = sensor.magnetic.hard_iron_b;
    } else if (block.key.kind == BlockKind::kDeclination) {
      parameters(offset) = sensor.magnetic.declination;
    } else if (block.key.kind == BlockKind::kMounting && travel_b &&
               sensor.mounting_sigma->z() > kRoughlyKnown) {
      parameters.segment<3>(offset) = Log(Eigen::Quaterniond::FromTwoVectors(
          sensor.q_sb * *travel_b, Eigen::Vector3d::UnitX()));
    }
  }
  return parameters;
}

}  // namespace hindsight
