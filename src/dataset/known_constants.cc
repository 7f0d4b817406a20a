#include "dataset/known_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.h"
#include "dataset/dataset.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::array<const char*, 3> kAxes = {"[x]", "[y]", "[z]"};

bool HasOwnClock(const AidingStream& stream) {
  return stream.clock_unknown || stream.clock_placed;
}

/// Nothing: it is not estimated.
std::optional<Eigen::Vector3d> PriorSigma(const SensorBlock& declared,
                                          const AidingStream& stream) {
  std::optional<MeasurementModel> first;
  if (!stream.measurements.empty()) first = stream.measurements.front().model;
  return declared.sigma(stream.sensor, first ? &*first : nullptr);
}

/// What is known of the components of one block.
struct KnownBlock {
  std::array<int, 3> index = {-1, -1, -1};  ///< into KnownConstants
  bool any() const {
    return *std::max_element(index.begin(), index.end()) >= 0;
  }
};

class Taker {
 public:
  Taker(const KnownConstants& known, Dataset* dataset)
      : known_(known), dataset_(*dataset) {}

  void TakeAll(const std::vector<std::string>& without) {
    TakeImuScale("gyro_scale", &dataset_.gyro_scale_sigma);
    TakeImuScale("accel_scale", &dataset_.accel_scale_sigma);
    for (AidingStream& stream : dataset_.streams) {
      for (const SensorBlock& block : stream.sensor.kind->blocks) {
        TakeBlock(block, &stream);
      }
    }
    RequireAllTaken(without);
    for (AidingStream& stream : dataset_.streams) {
      const int vehicle = stream.sensor.vehicle;
      if (vehicle < 0) continue;
      stream.sensor.q_sb =
          dataset_.streams[static_cast<std::size_t>(vehicle)].sensor.q_sb;
    }
    dataset_.constants = known_;
  }

 private:
  KnownBlock Find(const std::string& name, int count) {
    KnownBlock block;
    for (int i = 0; i < count; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      const std::string full = count == 1 ? name : name + kAxes[axis];
      block.index[axis] = known_.Find(full);
      if (block.index[axis] >= 0) taken_.insert(full);
    }
    return block;
  }

  /// Where something is known of a component: its value and sigma.
  void Put(const KnownBlock& block, Eigen::Vector3d* value,
           Eigen::Vector3d* sigma) const {
    for (int axis = 0; axis < 3; ++axis) {
      const int i = block.index[static_cast<std::size_t>(axis)];
      if (i < 0) continue;
      (*value)(axis) = known_.value(i);
      (*sigma)(axis) = std::sqrt(known_.P(i, i));
    }
  }

  [[noreturn]] void FailNotEstimated(const std::string& name,
                                     const std::string& key) const {
    throw InputError(known_.source + " knows " + name +
                     ", which is not estimated here; expected " + key +
                     ", or its name under constants.without");
  }

  void TakeImuScale(const std::string& name,
                    std::optional<Eigen::Vector3d>* sigma) {
    const KnownBlock block = Find(name, 3);
    if (!block.any()) return;
    if (!*sigma) FailNotEstimated(name, "imu.estimate." + name);
    Eigen::Vector3d unused = Eigen::Vector3d::Zero();
    Put(block, &unused, &**sigma);
  }

  void TakeBlock(const SensorBlock& declared, AidingStream* stream) {
    Sensor* sensor = &stream->sensor;
    const std::string name = sensor->name + "_" + std::string(declared.name);
    const KnownBlock block = Find(name, FullDimension(declared.kind));
    if (!block.any() || declared.know == nullptr) return;
    if (declared.kind == BlockKind::kTimeOffset && HasOwnClock(*stream)) {
      dataset_.notes.push_back(
          name + " of " + known_.source +
          " is not used: the clock is this recording's own (" +
          (stream->clock_unknown ? "time_offset: unknown"
                                 : "stamps that the configuration places") +
          ")");
      return;
    }
    std::optional<Eigen::Vector3d> sigma = PriorSigma(declared, *stream);
    if (!sigma) {
      FailNotEstimated(name, "aiding." + sensor->name + ".estimate." +
                                 std::string(declared.name));
    }
    Eigen::Vector3d value = declared.value == nullptr ? Eigen::Vector3d::Zero()
                                                      : declared.value(*sensor);
    Put(block, &value, &*sigma);
    if (declared.kind == BlockKind::kMounting) {
      const auto whole = known_.q_sb.find(sensor->name);
      if (whole != known_.q_sb.end()) {
        value = Log(whole->second * sensor->q_sb.conjugate());
      }
    }
    declared.know(value, *sigma, sensor);
  }

  /// Biases are those of one switching-on; a vehicle's name may be left out.
  void RequireAllTaken(const std::vector<std::string>& without) const {
    for (const std::string& name : known_.names) {
      if (taken_.contains(name) || name.starts_with("gyro_bias") ||
          name.starts_with("accel_bias")) {
        continue;
      }
      const bool left_out = std::any_of(without.begin(), without.end(),
                                        [&](const std::string& stream) {
                                          return name.starts_with(stream + "_");
                                        });
      if (left_out || OfOneRecording(name)) continue;
      throw InputError(known_.source + " knows " + name +
                       ", but no sensor here has such a constant; expected "
                       "the sensor, or its name under constants.without");
    }
  }

  /// A block in NED axes.
  bool OfOneRecording(const std::string& name) const {
    for (const AidingStream& stream : dataset_.streams) {
      for (const SensorBlock& block : stream.sensor.kind->blocks) {
        if (block.know == nullptr &&
            name.starts_with(stream.sensor.name + "_" +
                             std::string(block.name) + "[")) {
          return true;
        }
      }
    }
    return false;
  }

  const KnownConstants& known_;
  Dataset& dataset_;
  std::set<std::string> taken_;
};

}  // namespace

int KnownConstants::Find(const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

std::vector<std::string> ConstantsOfOneRecording(const Dataset& dataset) {
  std::vector<std::string> names;
  for (const AidingStream& stream : dataset.streams) {
    for (const SensorBlock& block : stream.sensor.kind->blocks) {
      const bool own =
          block.know == nullptr ||
          (block.kind == BlockKind::kTimeOffset && HasOwnClock(stream));
      if (own && PriorSigma(block, stream)) {
        names.push_back(stream.sensor.name + "_" + std::string(block.name));
      }
    }
  }
  return names;
}

void UseConstants(const KnownConstants& known,
                  const std::vector<std::string>& without, Dataset* dataset) {
  Taker(known, dataset).TakeAll(without);
}

}  // namespace hindsight
