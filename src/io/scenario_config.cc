#include "io/scenario_config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "base/units.h"
#include "io/config_streams.h"
#include "io/paths.h"
#include "simulation/builtin_scenarios.h"

namespace hindsight {
namespace {

Geodetic ReadPosition(ConfigMap* map) {
  const std::vector<std::string> items = map->List("position");
  if (items.size() != 3) {
    map->Fail("position", "expected [latitude, longitude, height]");
  }
  constexpr std::array kQuantities = {Quantity::kAngle, Quantity::kAngle,
                                      Quantity::kLength};
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    try {
      values[i] = ParseQuantity(items[i], kQuantities[i]);
    } catch (const std::invalid_argument& error) {
      map->Fail("position", error.what());
    }
  }
  if (std::abs(values[0]) > 0.5 * kPi) {
    map->Fail("position", "the latitude lies beyond 90 deg");
  }
  return {values[0], values[1], values[2]};
}

Segment ReadSegment(ConfigMap* map) {
  constexpr double kUsualDeceleration = 2.0;
  Segment s;
  switch (map->Choice("type",
                      {"straight", "stop", "accelerate", "turn", "pitch"},
                      std::nullopt)) {
    case 0:
      s = Segment::Straight(map->Positive("duration", Quantity::kTime));
      break;
    case 1:
      s = Segment::Stop(map->Positive("duration", Quantity::kTime),
                        map->Positive("deceleration", Quantity::kAcceleration,
                                      kUsualDeceleration));
      break;
    case 2:
      s = Segment::Accelerate(map->Number("speed", Quantity::kSpeed),
                              map->Positive("rate", Quantity::kAcceleration));
      break;
    case 3:
      s = Segment::Turn(map->Number("angle", Quantity::kAngle),
                        map->Positive("rate", Quantity::kAngularRate));
      s.banked = map->Flag("banked", false);
      break;
    default:
      s = Segment::Pitch(map->Number("angle", Quantity::kAngle),
                         map->Positive("rate", Quantity::kAngularRate));
  }
  s.blend = map->Number("blend", Quantity::kTime, s.blend);
  map->Finish();
  return s;
}

void ReadSegments(ConfigMap* top, Scenario* scenario) {
  if (top->Has("wander")) {
    if (top->Has("segments")) top->Fail("wander", "does not go with segments");
    ConfigMap wander = top->Map("wander");
    const int seed = wander.Integer("seed", 1);
    if (seed < 0) wander.Fail("seed", "must not be negative");
    const double duration = wander.Positive("duration", Quantity::kTime);
    if (duration > kLongestScenario) {
      wander.Fail("duration", "expected at most 31 days");
    }
    wander.Finish();
    scenario->segments =
        WanderingDrive(duration, static_cast<std::uint64_t>(seed));
    scenario->duration = duration;
    return;
  }
  for (ConfigMap& map : top->Maps("segments")) {
    scenario->segments.push_back(ReadSegment(&map));
  }
  if (!top->Has("segments")) {
    top->Fail("segments", "is missing; expected segments, wander or profile");
  }
  try {
    MotionProfile(scenario->segments, scenario->start_speed,
                  scenario->start_heading);
  } catch (const InputError& error) {
    top->Fail("segments", error.what());
  }
}

void ReadMotion(ConfigMap* top, const std::filesystem::path& folder,
                Scenario* scenario) {
  if (top->Has("profile")) {
    for (const char* key : {"start", "segments", "wander"}) {
      if (top->Has(key)) top->Fail(key, "does not go with profile");
    }
    scenario->profile =
        ReadMotionProfile((folder / top->Text("profile")).string());
    return;
  }
  ConfigMap start = top->Map("start");
  scenario->start = ReadPosition(&start);
  scenario->start_heading = start.Number("heading", Quantity::kAngle, 0.0);
  scenario->start_speed = start.Number("speed", Quantity::kSpeed, 0.0);
  start.Finish();
  ReadSegments(top, scenario);
}

/// Three standard deviations that may be zero, or one for all.
Eigen::Vector3d ReadSpread(ConfigMap* map, const std::string& key,
                           Quantity quantity) {
  const Eigen::Vector3d sigma = map->OptionalVector(key, quantity, true)
                                    .value_or(Eigen::Vector3d::Zero());
  if (sigma.minCoeff() < 0.0) map->Fail(key, "must not be negative");
  return sigma;
}

void ReadImuModel(ConfigMap* top, Scenario* scenario) {
  ConfigMap map = top->Map("imu");
  ImuErrorModel& model = scenario->imu;
  scenario->imu_kind = map.Choice("kind", {"increments", "rates"}, 0) == 0
                           ? ImuStream::Kind::kIncrements
                           : ImuStream::Kind::kRates;
  scenario->imu_rate_hz =
      map.Positive("rate", Quantity::kFrequency, scenario->imu_rate_hz);
  model.noise = ReadImuNoise(&map);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  model.gyro_bias = map.Vector("gyro_bias", Quantity::kAngularRate, zero);
  model.accel_bias = map.Vector("accel_bias", Quantity::kAcceleration, zero);
  model.gyro_bias_sigma =
      ReadSpread(&map, "gyro_bias_sigma", Quantity::kAngularRate);
  model.accel_bias_sigma =
      ReadSpread(&map, "accel_bias_sigma", Quantity::kAcceleration);
  model.gyro_scale = map.Vector("gyro_scale", Quantity::kRatio, zero);
  model.accel_scale = map.Vector("accel_scale", Quantity::kRatio, zero);
  map.Finish();
}

/// What a sensor errs by: its noise, and the a priori sigmas of its
/// calibration.
void ReadAidingErrors(ConfigMap* map, AidingModel* model) {
  Sensor& sensor = model->sensor;
  if (sensor.type == SensorType::kDvl) {
    ReadDvl(map, &sensor, &model->dvl);
    model->beam_dropout = map->Number("beam_dropout", Quantity::kRatio, 0.0);
    model->current_n =
        map->Vector("true_current", Quantity::kSpeed, Eigen::Vector3d::Zero());
  } else if (sensor.type == SensorType::kAcousticFix) {
    ReadAcoustic(map, &sensor, &model->acoustic);
  } else {
    const auto sigma = map->OptionalSigma(
        "sigma", sensor.type == SensorType::kVelocity ? Quantity::kSpeed
                                                      : Quantity::kLength);
    if (!sigma) map->Fail("sigma", "is missing");
    model->sigma = *sigma;
  }
  ReadCalibrationSigmas(map, &sensor);
  model->draw_calibration = true;
}

AidingModel ReadAidingModel(const std::string& name, ConfigMap* map) {
  constexpr std::array kTypes = {SensorType::kPosition, SensorType::kVelocity,
                                 SensorType::kHeight, SensorType::kDvl,
                                 SensorType::kAcousticFix};
  if (name == "imu" || name == "truth") {
    map->Fail("type", "the name '" + name + "' is taken by another file");
  }
  AidingModel model;
  model.sensor.name = name;
  model.sensor.type = kTypes[map->Choice(
      "type", {"position", "velocity", "height", "dvl", "acoustic"},
      std::nullopt)];
  ReadAidingErrors(map, &model);
  model.rate_hz = map->Positive("rate", Quantity::kFrequency, model.rate_hz);
  model.sensor.lever_arm_b =
      map->Vector("lever_arm", Quantity::kLength, Eigen::Vector3d::Zero());
  model.sensor.time_offset = map->Number("time_offset", Quantity::kTime, 0.0);
  model.sensor.gate_probability = ReadGate(map);
  model.from =
      map->OptionalNumber("from", Quantity::kTime).value_or(model.from);
  model.to = map->OptionalNumber("to", Quantity::kTime).value_or(model.to);
  for (ConfigMap& outage : map->Maps("outages")) {
    const double from = outage.Number("from", Quantity::kTime);
    const double to = outage.Number("to", Quantity::kTime);
    if (to <= from) outage.Fail("to", "must be later than from");
    outage.Finish();
    model.outages.push_back({from, to});
  }
  map->Finish();
  return model;
}

void ReadStartErrors(ConfigMap* top, Scenario* scenario) {
  if (!top->Has("start_errors")) return;
  ConfigMap map = top->Map("start_errors");
  const auto sigma = [&](const char* key, Quantity quantity) {
    const auto value = map.OptionalSigma(key, quantity);
    if (!value) map.Fail(key, "is missing");
    return *value;
  };
  StartErrors errors;
  errors.position = sigma("position", Quantity::kLength);
  errors.velocity = sigma("velocity", Quantity::kSpeed);
  errors.attitude = sigma("attitude", Quantity::kAngle);
  map.Finish();
  scenario->start_errors = errors;
}

}  // namespace

std::vector<std::filesystem::path> ScenarioFiles(const std::string& path) {
  ConfigMap top = ConfigMap::Load(path);
  const std::filesystem::path file(path);
  if (!top.Has("profile")) return {file};
  return {file, file.parent_path() / top.Text("profile")};
}

Scenario LoadScenario(const std::string& path) {
  ConfigMap top = ConfigMap::Load(path);
  const std::filesystem::path file(path);
  Scenario scenario;
  scenario.name = top.Text("name", file.stem().string());
  scenario.description = top.Text("description", "");
  ReadMotion(&top, file.parent_path(), &scenario);
  if (top.Has("duration")) {
    scenario.duration = top.Positive("duration", Quantity::kTime);
  }
  ReadImuModel(&top, &scenario);
  if (top.Has("aiding")) {
    ConfigMap aiding = top.Map("aiding");
    for (auto& [name, map] : aiding.NamedMaps()) {
      scenario.aiding.push_back(ReadAidingModel(name, &map));
    }
  }
  scenario.truth_rate_hz =
      top.Positive("truth_rate", Quantity::kFrequency, scenario.truth_rate_hz);
  ReadStartErrors(&top, &scenario);
  scenario.stationary = ReadStationary(&top);
  scenario.withholdings = ReadWithholdings(&top);
  ConfigMap nodes = top.Map("nodes");
  scenario.max_node_spacing =
      nodes.Positive("max_spacing", Quantity::kTime, scenario.max_node_spacing);
  nodes.Finish();
  top.Finish();
  return scenario;
}

Scenario FindScenario(const std::string& name_or_path) {
  const std::vector<std::string> names = BuiltinScenarioNames();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end() ||
      !PathExists(name_or_path)) {
    return BuiltinScenario(name_or_path);
  }
  return LoadScenario(name_or_path);
}

}  // namespace hindsight
