#include "io/write/dataset_config.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "io/read/units.h"
#include "io/write/number_format.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr int kDigits = 12;

/// A unit as it is written and its size in SI.
struct PrintedUnit {
  const char* name;
  double si = 1.0;
};
constexpr PrintedUnit kMetres{"m"};
constexpr PrintedUnit kSeconds{"s"};
constexpr PrintedUnit kMetresPerSecond{"m/s"};
constexpr PrintedUnit kDegrees{"deg", kDegree};
constexpr PrintedUnit kDegreesPerHour{"deg/h", kDegree / kHour};
constexpr PrintedUnit kMilliGs{"mg", kMilliG};

std::string NumberText(double value, const PrintedUnit& unit) {
  return FormatGeneral(value / unit.si, kDigits) + " " + unit.name;
}

/// A map of YAML in the order in which its keys are put in.
class YamlMap {
 public:
  void Text(const std::string& key, const std::string& value) {
    node_[key] = value;
  }
  void Number(const std::string& key, double value, const PrintedUnit& unit) {
    Text(key, NumberText(value, unit));
  }
  /// On one line.
  void List(const std::string& key, const std::vector<std::string>& values) {
    YAML::Node list(values);
    list.SetStyle(YAML::EmitterStyle::Flow);
    node_[key] = list;
  }
  void Vector(const std::string& key, const Eigen::Vector3d& value,
              const PrintedUnit& unit) {
    List(key, {NumberText(value.x(), unit), NumberText(value.y(), unit),
               NumberText(value.z(), unit)});
  }
  void Vector(const std::string& key,
              const std::optional<Eigen::Vector3d>& value,
              const PrintedUnit& unit) {
    if (value) Vector(key, *value, unit);
  }
  /// Latitude, longitude and height.
  void Position(const std::string& key, const Geodetic& position) {
    constexpr int kAngleDigits = 16;
    List(key,
         {FormatGeneral(position.latitude / kDegree, kAngleDigits) + " deg",
          FormatGeneral(position.longitude / kDegree, kAngleDigits) + " deg",
          NumberText(position.height, kMetres)});
  }
  /// Left out while it is empty.
  void Map(const std::string& key, const YamlMap& inside) {
    if (inside.node_.size() > 0) node_[key] = inside.node_;
  }
  /// Maps, a line each.
  void Lines(const std::string& key, const std::vector<YamlMap>& maps) {
    for (const YamlMap& map : maps) {
      YAML::Node line = map.node_;
      line.SetStyle(YAML::EmitterStyle::Flow);
      node_[key].push_back(line);
    }
  }
  std::string Emit() const {
    YAML::Emitter emitter;
    emitter << node_;
    return std::string(emitter.c_str()) + "\n";
  }

 private:
  YAML::Node node_{YAML::NodeType::Map};
};

YamlMap NoiseMap(const ImuNoise& noise) {
  YamlMap yaml;
  yaml.Number("gyro", noise.gyro_noise_density,
              {"deg/sqrt(h)", kDegreePerSqrtHour});
  yaml.Number("accel", noise.accel_noise_density, {"m/s/sqrt(h)", 1.0 / 60.0});
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
  if (noise.gyro_noise_per_rate > 0.0) {
    yaml.Number("gyro_per_rate", noise.gyro_noise_per_rate, {"sqrt(s)"});
  }
  return yaml;
}

/// The unit in which people write a quantity.
PrintedUnit UnitOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kAngle:
      return kDegrees;
    case Quantity::kAngularRate:
      return {"deg/s", kDegree};
    default:
      return {SiUnit(quantity)};
  }
}

/// One key of a stream's settings; what is not given is left out.
class KeyText {
 public:
  KeyText(const SensorKey& key, const SensorSettings& settings,
          const SensorSettings& defaults, YamlMap* yaml)
      : key_(key),
        name_(key.name.substr(key.name.rfind('.') + 1)),
        unit_(UnitOf(key.quantity)),
        settings_(settings),
        defaults_(defaults),
        yaml_(*yaml) {}

  void Append() {
    std::visit([this](const auto& value) { Put(value); }, key_.value);
  }

 private:
  bool Stands(double value, double fallback) const {
    return std::isfinite(value) && (IsNeeded() || value != fallback);
  }
  bool IsNeeded() const {
    return key_.needed != nullptr && key_.needed(settings_);
  }
  /// What `at` finds in settings that it may change.
  template <class T>
  T& In(T* (*at)(SensorSettings&), const SensorSettings& settings) const {
    return *at(const_cast<SensorSettings&>(settings));
  }

  void Put(const SensorKey::Number& key) {
    const double value = In(key.at, settings_);
    if (Stands(value, In(key.at, defaults_))) {
      yaml_.Number(name_, value, unit_);
    }
  }
  void Put(const SensorKey::OptionalNumber& key) {
    const auto& value = In(key.at, settings_);
    if (value) yaml_.Number(name_, *value, unit_);
  }
  void Put(const SensorKey::Vector& key) {
    const Eigen::Vector3d& value = In(key.at, settings_);
    if (value != In(key.at, defaults_)) yaml_.Vector(name_, value, unit_);
  }
  void Put(const SensorKey::OptionalSigmas& key) {
    const auto& value = In(key.at, settings_);
    if (!value) return;
    if (key.one) {
      yaml_.Number(name_, value->x(), unit_);
    } else {
      yaml_.Vector(name_, *value, unit_);
    }
  }
  void Put(const SensorKey::SidesSigma& key) {
    const auto& value = In(key.at, settings_);
    if (!value) return;
    yaml_.List(name_,
               {NumberText(value->y(), unit_), NumberText(value->z(), unit_)});
  }
  void Put(const SensorKey::Mounting&) {
    yaml_.Vector(name_, EulerFromQuaternion(settings_.sensor.q_sb), kDegrees);
  }
  /// The measurements are in body axes already.
  void Put(const SensorKey::Axes&) {}
  void Put(const SensorKey::Place& key) {
    yaml_.Position(name_, GeodeticFromEcef(In(key.at, settings_)));
  }
  void Put(const SensorKey::Word& key) {
    if (!IsNeeded() && key.get(settings_) == key.get(defaults_)) return;
    yaml_.Text(name_, std::string(key.words[key.get(settings_)]));
  }

  const SensorKey& key_;
  const std::string name_;
  const PrintedUnit unit_;
  const SensorSettings& settings_;
  const SensorSettings& defaults_;
  YamlMap& yaml_;
};

/// Keys whose names begin with `prefix` and a dot, or without one.
void AppendKeys(std::string_view prefix, const SensorSettings& settings,
                YamlMap* yaml) {
  const SensorKind& kind = *settings.sensor.kind;
  const SensorSettings defaults = SettingsOf(kind);
  for (const SensorKey& key : kind.keys) {
    const std::size_t dot = key.name.find('.');
    const std::string_view of =
        dot == key.name.npos ? std::string_view() : key.name.substr(0, dot);
    if (of != prefix || key.simulated ||
        (key.applies != nullptr && !key.applies(settings))) {
      continue;
    }
    KeyText(key, settings, defaults, yaml).Append();
  }
}

/// Names of the maps that the keys of a kind stand in, but for `estimate`.
std::vector<std::string_view> MapsOf(const SensorKind& kind) {
  std::vector<std::string_view> maps;
  for (const SensorKey& key : kind.keys) {
    const std::size_t dot = key.name.find('.');
    if (dot == key.name.npos) continue;
    const std::string_view map = key.name.substr(0, dot);
    if (map != "estimate" && (maps.empty() || maps.back() != map)) {
      maps.push_back(map);
    }
  }
  return maps;
}

YamlMap SensorMap(const AidingStream& stream) {
  const Sensor& sensor = stream.sensor;
  const SensorKind& kind = *sensor.kind;
  SensorSettings settings = SettingsOf(kind);
  settings.sensor = sensor;
  settings.pattern = stream.measurements.front().model;
  if (kind.uncomplete != nullptr) kind.uncomplete(&settings);
  YamlMap yaml;
  yaml.Text("type", std::string(kind.name));
  yaml.Text("file", sensor.name + ".csv");
  AppendKeys("", settings, &yaml);
  for (const std::string_view name : MapsOf(kind)) {
    YamlMap map;
    AppendKeys(name, settings, &map);
    yaml.Map(std::string(name), map);
  }
  if (stream.clock_unknown) {
    yaml.Text("time_offset", "unknown");
  } else if (sensor.time_offset != 0.0) {
    yaml.Number("time_offset", sensor.time_offset, kSeconds);
  }
  if (sensor.gate_probability) {
    yaml.Text("gate", FormatGeneral(*sensor.gate_probability, kDigits));
  }
  YamlMap estimate;
  AppendKeys("estimate", settings, &estimate);
  // That of an unknown clock comes with the search for it.
  if (sensor.time_offset_sigma && !stream.clock_unknown) {
    estimate.Number("time_offset", *sensor.time_offset_sigma, kSeconds);
  }
  yaml.Map("estimate", estimate);
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
