#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

#include "dataset/bias_sigma.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude.h"

namespace hindsight {
namespace {

/// Keys of a used sensor that attitude alone makes nothing of.
std::string UnusedKeys(const Sensor& sensor) {
  std::string keys;
  const auto name = [&keys](bool given, std::string_view key) {
    if (given) keys += (keys.empty() ? "'" : ", '") + std::string(key) + "'";
  };
  name(sensor.gate_probability.has_value(), "gate");
  name(sensor.loss.kind == RobustLoss::Kind::kMixture, "noise");
  name(sensor.loss.kind != RobustLoss::Kind::kNone &&
           sensor.loss.kind != RobustLoss::Kind::kMixture,
       "loss");
  name(sensor.mounting_sigma.has_value(), "estimate.mounting");
  name(!sensor.kind->magnetic && sensor.time_offset_sigma.has_value(),
       "estimate.time_offset");
  name(sensor.lever_arm_sigma.has_value(), "estimate.lever_arm");
  return keys;
}

}  // namespace

std::vector<std::string> AttitudeEstimation::Unused() const {
  std::vector<std::string> unused;
  if (!dataset_.initial.accel_bias_sigma) {
    unused.push_back(
        fmt::format("no 'initial.accel_bias_sigma': the sigma of the tilt is "
                    "that of accelerometers with {:.2g} m/s^2",
                    AccelBiasSigma(dataset_.initial).maxCoeff()));
  }
  bool magnetometer = false;
  for (const AidingStream& stream : dataset_.streams) {
    const Sensor& sensor = stream.sensor;
    if (stream.measurements.empty()) continue;
    const bool first = sensor.kind->magnetic && !magnetometer;
    magnetometer = magnetometer || sensor.kind->magnetic;
    const bool velocity = std::holds_alternative<VelocityFix>(
        Measurement(stream.measurements.front()).model);
    if (first || sensor.kind->is_heading ||
        (velocity && !velocities_.empty())) {
      if (const std::string keys = UnusedKeys(sensor); !keys.empty()) {
        unused.push_back("no use for " + keys + " of '" + sensor.name +
                         "' in attitude alone");
      }
      continue;
    }
    unused.push_back(
        "no use for '" + sensor.name + "' (" + std::string(sensor.kind->name) +
        (velocity ? "): nothing tells the heading, nor do the velocities "
                    "themselves"
                  : "): attitude alone is of one magnetometer, headings and "
                    "velocities over the Earth"));
  }
  return unused;
}

std::vector<std::string> AttitudeEstimation::UnusedByFilter() const {
  std::vector<std::string> unused;
  if (const AidingStream* stream = MagnetometerOf(dataset_);
      stream != nullptr && stream->sensor.time_offset_sigma) {
    unused.push_back("no use for 'estimate.time_offset' of '" +
                     stream->sensor.name +
                     "': the smoother finds it, in what comes later");
  }
  if (dataset_.stationary.enabled) {
    unused.emplace_back(
        "no use for 'stationary': what knows nothing later finds rest by "
        "thresholds of its own");
  }
  return unused;
}

}  // namespace hindsight
