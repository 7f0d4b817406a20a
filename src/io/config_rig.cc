#include <array>
#include <cmath>

#include "base/units.h"
#include "io/config_streams.h"

namespace hindsight {
namespace {

struct AidingType {
  const char* name;
  SensorType type;
  const std::vector<FieldName>& (*fields)();
  Quantity sigma;
};

constexpr std::array kAidingTypes = {
    AidingType{"position", SensorType::kPosition, PositionFields,
               Quantity::kLength},
    AidingType{"velocity", SensorType::kVelocity, VelocityFields,
               Quantity::kSpeed},
    AidingType{"height", SensorType::kHeight, HeightFields, Quantity::kLength},
};

const AidingType& ReadType(ConfigMap* map) {
  std::vector<std::string> names;
  for (const AidingType& type : kAidingTypes) names.emplace_back(type.name);
  return kAidingTypes[map->Choice("type", names, std::nullopt)];
}

std::optional<double> ReadGate(ConfigMap* map) {
  const std::string text = map->Text("gate", "off");
  if (text == "off") return std::nullopt;
  double probability = 0.0;
  if (const auto number = ParseNumber(text)) {
    probability = *number;
  } else {
    probability = map->Number("gate", Quantity::kRatio);
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    map->Fail("gate", "'" + text +
                          "' is not a probability; expected off, or a value "
                          "between 0 and 1, such as 99.9 %");
  }
  map->Resolve("gate", probability, Quantity::kRatio);
  return probability;
}

std::set<int> ReadQualities(ConfigMap* map) {
  std::set<int> accepted;
  for (const std::string& text : map->List("accept_quality")) {
    const auto number = ParseNumber(text);
    if (!number || *number != std::floor(*number) || std::abs(*number) > 1e6) {
      map->Fail("accept_quality", "'" + text + "' is not a whole number");
    }
    accepted.insert(static_cast<int>(*number));
  }
  return accepted;
}

}  // namespace

AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder) {
  AidingConfig config;
  const AidingType& type = ReadType(map);
  config.sensor.name = name;
  config.sensor.type = type.type;
  config.source = ReadStreamSource(map, folder, type.fields());
  config.options.type = type.type;
  config.options.sigma = map->OptionalSigma("sigma", type.sigma);
  if (!config.options.sigma) {
    const std::string scale = map->Text("sigma_scale", "1");
    const auto number = ParseNumber(scale);
    if (!number || !(*number > 0.0)) {
      map->Fail("sigma_scale", "'" + scale + "' is not a positive number");
    }
    config.options.sigma_scale = *number;
    config.options.use_correlations = map->Flag("correlations", true);
  } else if (map->Has("sigma_scale")) {
    map->Fail("sigma_scale", "does not go with sigma");
  }
  config.options.accept_quality = ReadQualities(map);
  config.sensor.lever_arm_b =
      map->Vector("lever_arm", Quantity::kLength, Eigen::Vector3d::Zero());
  config.sensor.time_offset = map->Number("time_offset", Quantity::kTime, 0.0);
  config.sensor.gate_probability = ReadGate(map);
  ConfigMap estimate = map->Map("estimate");
  config.sensor.lever_arm_sigma =
      estimate.OptionalSigma("lever_arm", Quantity::kLength);
  if (estimate.Has("time_offset")) {
    config.sensor.time_offset_sigma =
        estimate.Positive("time_offset", Quantity::kTime);
  }
  estimate.Finish();
  map->Finish();
  return config;
}

InitialState ReadInitialState(ConfigMap* top) {
  InitialState initial;
  ConfigMap map = top->Map("initial");
  initial.t = map.OptionalNumber("time", Quantity::kTime);
  if (map.Has("position")) {
    const std::vector<std::string> items = map.List("position");
    if (items.size() != 3) {
      map.Fail("position", "expected [latitude, longitude, height]");
    }
    constexpr std::array kUnits = {Quantity::kAngle, Quantity::kAngle,
                                   Quantity::kLength};
    std::array<double, 3> values;
    YAML::Node list(YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < 3; ++i) {
      try {
        values[i] = ParseQuantity(items[i], kUnits[i]);
      } catch (const std::invalid_argument& error) {
        map.Fail("position", error.what());
      }
      list.push_back(FormatNumber(values[i]) + " " + SiUnit(kUnits[i]));
    }
    list.SetStyle(YAML::EmitterStyle::Flow);
    map.resolved()["position"] = list;
    if (std::abs(values[0]) > kPi / 2.0) {
      map.Fail("position", "the latitude lies beyond 90 deg");
    }
    initial.position = Geodetic{values[0], values[1], values[2]};
  }
  initial.v_n = map.OptionalVector("velocity", Quantity::kSpeed);
  initial.euler = map.OptionalVector("attitude", Quantity::kAngle);
  initial.heading = map.OptionalNumber("heading", Quantity::kAngle);
  if (initial.euler && initial.heading) {
    map.Fail("heading", "does not go with attitude, which holds it");
  }
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  initial.gyro_bias = map.Vector("gyro_bias", Quantity::kAngularRate, zero);
  initial.accel_bias = map.Vector("accel_bias", Quantity::kAcceleration, zero);
  initial.position_sigma =
      map.OptionalSigma("position_sigma", Quantity::kLength);
  initial.velocity_sigma =
      map.OptionalSigma("velocity_sigma", Quantity::kSpeed);
  initial.attitude_sigma =
      map.OptionalSigma("attitude_sigma", Quantity::kAngle);
  initial.gyro_bias_sigma =
      map.OptionalSigma("gyro_bias_sigma", Quantity::kAngularRate);
  initial.accel_bias_sigma =
      map.OptionalSigma("accel_bias_sigma", Quantity::kAcceleration);
  map.Finish();
  return initial;
}

StationaryOptions ReadStationary(ConfigMap* top) {
  StationaryOptions options;
  const bool is_map = top->IsMap("stationary");
  if (!is_map && top->Choice("stationary", {"off", "on"}, 0) == 0) {
    return options;
  }
  ConfigMap map = is_map ? top->Map("stationary") : top->Defaults("stationary");
  options.enabled = true;
  options.window = map.Positive("window", Quantity::kTime, options.window);
  options.gyro_threshold = map.Positive(
      "gyro_threshold", Quantity::kAngularRate, options.gyro_threshold);
  options.accel_threshold = map.Positive(
      "accel_threshold", Quantity::kAcceleration, options.accel_threshold);
  options.velocity_sigma =
      map.Positive("velocity_sigma", Quantity::kSpeed, options.velocity_sigma);
  options.rate_sigma =
      map.Positive("rate_sigma", Quantity::kAngularRate, options.rate_sigma);
  map.Finish();
  return options;
}

std::vector<Withholding> ReadWithholdings(ConfigMap* top) {
  std::vector<Withholding> withholdings;
  for (ConfigMap& map : top->Maps("withhold")) {
    Withholding withholding;
    withholding.sensor = map.Text("sensor");
    withholding.every = map.Positive("every", Quantity::kTime);
    withholding.length = map.Positive("length", Quantity::kTime);
    withholding.from = map.OptionalNumber("from", Quantity::kTime);
    if (withholding.length > withholding.every) {
      map.Fail("length", "must not be longer than every");
    }
    map.Finish();
    withholdings.push_back(withholding);
  }
  return withholdings;
}

}  // namespace hindsight
