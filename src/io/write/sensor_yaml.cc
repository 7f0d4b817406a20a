#include "io/write/sensor_yaml.h"

#include <cmath>
#include <string_view>
#include <variant>

#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

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
  void Put(const SensorKey::Whole& key) {
    const double value = In(key.at, settings_);
    if (value != In(key.at, defaults_)) {
      yaml_.Text(name_, std::to_string(static_cast<int>(value)));
    }
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

}  // namespace

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
    yaml.Text("gate", FormatGeneral(*sensor.gate_probability, kYamlDigits));
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

}  // namespace hindsight
