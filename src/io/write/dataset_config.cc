#include "io/write/dataset_config.h"

#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "imu/imu_noise.h"
#include "io/read/units.h"
#include "io/write/sensor_yaml.h"
#include "io/write/yaml_map.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

YamlMap NoiseMap(const ImuNoise& noise) {
  YamlMap yaml;
  for (const ImuNoiseValue& value : ImuNoiseValues()) {
    const double here = noise.*value.at;
    if (!value.needed && here == 0.0) continue;
    yaml.Number(std::string(value.name), here, {value.unit, value.unit_si});
  }
  const auto bias = [&](const std::string& sensor, double walk, double tau,
                        const PrintedUnit& walk_unit,
                        const PrintedUnit& bias_unit) {
    if (walk <= 0.0) return;
    if (std::isfinite(tau)) {
      yaml.Number(sensor + "_bias_sigma", walk * std::sqrt(0.5 * tau),
                  bias_unit);
      yaml.Number(sensor + "_bias_tau", tau, kSeconds);
    } else {
      yaml.Number(sensor + "_bias_walk", walk, walk_unit);
    }
  };
  bias("gyro", noise.gyro_bias_walk, noise.gyro_bias_tau, {"rad/s/sqrt(s)"},
       kDegreesPerHour);
  bias("accel", noise.accel_bias_walk, noise.accel_bias_tau, {"m/s^2/sqrt(s)"},
       kMilliGs);
  return yaml;
}

YamlMap InitialMap(const InitialState& initial) {
  YamlMap yaml;
  if (initial.t) yaml.Number("time", *initial.t, kSeconds);
  if (initial.position) {
    yaml.Position("position", *initial.position);
  }
  yaml.Vector("velocity", initial.v_n, kMetresPerSecond);
  yaml.Vector("attitude", initial.euler, kDegrees);
  if (initial.heading) yaml.Number("heading", *initial.heading, kDegrees);
  yaml.Vector("gyro_bias", initial.gyro_bias, kDegreesPerHour);
  yaml.Vector("accel_bias", initial.accel_bias, kMilliGs);
  yaml.Vector("position_sigma", initial.position_sigma, kMetres);
  yaml.Vector("velocity_sigma", initial.velocity_sigma, kMetresPerSecond);
  yaml.Vector("attitude_sigma", initial.attitude_sigma, kDegrees);
  yaml.Vector("gyro_bias_sigma", initial.gyro_bias_sigma, kDegreesPerHour);
  yaml.Vector("accel_bias_sigma", initial.accel_bias_sigma, kMilliGs);
  return yaml;
}

YamlMap StationaryMap(const StationaryOptions& options) {
  YamlMap yaml;
  if (!options.enabled) return yaml;
  yaml.Number("window", options.window, kSeconds);
  yaml.Number("gyro_threshold", options.gyro_threshold, {"rad/s"});
  yaml.Number("accel_threshold", options.accel_threshold, {"m/s^2"});
  yaml.Number("velocity_sigma", options.velocity_sigma, kMetresPerSecond);
  yaml.Number("rate_sigma", options.rate_sigma, {"rad/s"});
  return yaml;
}

std::vector<YamlMap> WithholdingMaps(
    const std::vector<Withholding>& withholdings) {
  std::vector<YamlMap> maps;
  for (const Withholding& w : withholdings) {
    YamlMap& map = maps.emplace_back();
    map.Text("sensor", w.sensor);
    map.Number("every", w.every, kSeconds);
    map.Number("length", w.length, kSeconds);
    if (w.from) map.Number("from", *w.from, kSeconds);
  }
  return maps;
}

}  // namespace

std::string DatasetConfigYaml(const Dataset& dataset) {
  YamlMap yaml;
  yaml.Text("name", dataset.name);
  YamlMap imu;
  imu.Text("file", "imu.csv");
  imu.Text("kind", dataset.imu.kind == ImuStream::Kind::kRates ? "rates"
                                                               : "increments");
  imu.Number("max_gap", dataset.imu.max_gap, kSeconds);
  imu.Map("noise", NoiseMap(dataset.imu.noise));
  yaml.Map("imu", imu);
  YamlMap aiding;
  for (const AidingStream& stream : dataset.streams) {
    // A recording without a single measurement has no file either.
    if (stream.measurements.empty()) continue;
    aiding.Map(stream.sensor.name, SensorMap(stream));
  }
  yaml.Map("aiding", aiding);
  const InitialState& initial = dataset.initial;
  yaml.Text("alignment",
            AlignmentNames()[static_cast<std::size_t>(initial.alignment)]);
  yaml.Map("initial", InitialMap(initial));
  yaml.Map("stationary", StationaryMap(dataset.stationary));
  if (!dataset.truth.empty()) {
    YamlMap truth;
    truth.Text("file", "truth.csv");
    if (!dataset.truth_lever_arm_b.isZero(0.0)) {
      truth.Vector("lever_arm", dataset.truth_lever_arm_b, kMetres);
    }
    yaml.Map("truth", truth);
  }
  yaml.Lines("withhold", WithholdingMaps(dataset.withholdings));
  YamlMap nodes;
  nodes.Number("max_spacing", dataset.max_node_spacing, kSeconds);
  yaml.Map("nodes", nodes);
  return "# Simulated recording; truth.csv is exact.\n" + yaml.Emit();
}

}  // namespace hindsight
