#include "alignment/start_layout.h"

#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

void AddImuScale(BlockKind kind, const char* name, std::string_view advice,
                 const std::optional<Eigen::Vector3d>& sigma,
                 std::vector<Block>* blocks) {
  if (!sigma) return;
  Block block;
  block.key.kind = kind;
  block.name = name;
  block.unit = "1";
  block.evolution = Evolution::Constant();
  block.sigma0 = *sigma;
  block.advice = advice;
  blocks->push_back(block);
}

/// What the kind of the stream's sensor declares.
void AddSensorBlocks(const AidingStream& stream, int index,
                     std::vector<Block>* blocks) {
  std::optional<MeasurementModel> first;
  if (!stream.measurements.empty()) first = stream.measurements.front().model;
  const Sensor& sensor = stream.sensor;
  for (const SensorBlock& declared : sensor.kind->blocks) {
    const auto sigma = declared.sigma(sensor, first ? &*first : nullptr);
    if (!sigma) continue;
    Block block;
    block.key = {declared.kind, index};
    block.name = sensor.name + "_" + std::string(declared.name);
    block.unit = declared.unit;
    block.evolution = declared.evolution == nullptr
                          ? Evolution::Constant()
                          : declared.evolution(sensor);
    block.sigma0 = *sigma;
    block.advice = declared.advice;
    blocks->push_back(block);
  }
}

/// Every block beyond the navigation state, in the order of the layout.
std::vector<Block> CalibrationBlocks(const Dataset& dataset) {
  std::vector<Block> blocks;
  AddImuScale(BlockKind::kGyroScale, "gyro_scale",
              "fast turns both ways about the axis", dataset.gyro_scale_sigma,
              &blocks);
  AddImuScale(BlockKind::kAccelScale, "accel_scale",
              "strong accelerations along the axis both ways, or rest in "
              "several attitudes",
              dataset.accel_scale_sigma, &blocks);
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    AddSensorBlocks(dataset.streams[i], static_cast<int>(i), &blocks);
  }
  return blocks;
}

/// What its kind says of the block beforehand; zero if it says nothing.
Eigen::Vector3d ValueOf(const Sensor& sensor, BlockKind kind) {
  for (const SensorBlock& declared : sensor.kind->blocks) {
    if (declared.kind == kind && declared.value != nullptr) {
      return declared.value(sensor);
    }
  }
  return Eigen::Vector3d::Zero();
}

/// Which of the known constants each component is, or -1. One whose sigma is
/// not that of the known one was not taken.
std::vector<int> KnownOf(const KnownConstants& known,
                         const ErrorLayout& layout) {
  std::vector<int> indices(static_cast<std::size_t>(layout.dim()), -1);
  const ErrorMatrix P = layout.InitialCovariance();
  for (const Block& block : layout.blocks()) {
    if (!block.evolution.is_constant()) continue;
    for (int i = block.offset; i < block.offset + block.dim; ++i) {
      const int at = known.Find(layout.ComponentName(i));
      constexpr double kRounding = 1e-9;
      if (at >= 0 && std::abs(P(i, i) / known.P(at, at) - 1.0) < kRounding) {
        indices[static_cast<std::size_t>(i)] = at;
      }
    }
  }
  return indices;
}

/// Values of an IMU's scale factors that other recordings tell.
void PutKnownValues(const KnownConstants& known, const ErrorLayout& layout,
                    const Block& block, ParameterVector* parameters) {
  for (int i = 0; i < block.dim; ++i) {
    const int at = known.Find(layout.ComponentName(block.offset + i));
    if (at >= 0) (*parameters)(block.parameter_offset + i) = known.value(at);
  }
}

}  // namespace

ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior) {
  ErrorLayout layout = NavigationLayout(prior);
  for (Block& block : CalibrationBlocks(dataset)) layout.Add(std::move(block));
  return layout;
}

ErrorMatrix InitialCovariance(const Dataset& dataset,
                              const ErrorLayout& layout) {
  ErrorMatrix P = layout.InitialCovariance();
  if (!dataset.constants) return P;
  const std::vector<int> known = KnownOf(*dataset.constants, layout);
  for (int i = 0; i < layout.dim(); ++i) {
    for (int j = 0; j < layout.dim(); ++j) {
      const int a = known[static_cast<std::size_t>(i)];
      const int b = known[static_cast<std::size_t>(j)];
      if (i != j && a >= 0 && b >= 0) P(i, j) = dataset.constants->P(a, b);
    }
  }
  return P;
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
    if (block.key.sensor == BlockKey::kNoSensor) {
      if (dataset.constants && block.parameter_offset >= 0) {
        PutKnownValues(*dataset.constants, layout, block, &parameters);
      }
      continue;
    }
    const Sensor& sensor =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)].sensor;
    const int offset = block.parameter_offset;
    const int count = FullDimension(block.key.kind);
    parameters.segment(offset, count) =
        ValueOf(sensor, block.key.kind).head(count);
    if (block.key.kind == BlockKind::kMounting && travel_b &&
        sensor.mounting_sigma->z() > kRoughlyKnown) {
      parameters.segment<3>(offset) = Log(Eigen::Quaterniond::FromTwoVectors(
          sensor.q_sb * *travel_b, Eigen::Vector3d::UnitX()));
    }
  }
  return parameters;
}

}  // namespace hindsight
