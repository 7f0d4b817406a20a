#include <string>

#include "io/config/config_streams.h"
#include "io/config/scenario_keys.h"
#include "io/config/sensor_keys.h"

namespace hindsight {
namespace {

struct SimulatedImu : ImuErrorModel {
  ImuStream::Kind kind = Scenario{}.imu_kind;
  double rate_hz = Scenario{}.imu_rate_hz;
};

const ConfigTable<SimulatedImu>& ImuModelTable() {
  using Imu = SimulatedImu;
  using Key = ConfigKey<Imu>;
  static const ConfigTable<Imu> kTable = {
      "scenario: imu",
      "",
      {{.name = "kind",
        .value = Key::Word{{"increments", "rates"},
                           [](const Imu& imu) {
                             return std::size_t{
                                 imu.kind == ImuStream::Kind::kRates ? 1U : 0U};
                           },
                           [](Imu& imu, std::size_t word) {
                             imu.kind = word == 1
                                            ? ImuStream::Kind::kRates
                                            : ImuStream::Kind::kIncrements;
                           }}},
       {.name = "rate",
        .quantity = Quantity::kFrequency,
        .value = Key::Number{&Imu::rate_hz, KeyRange::kPositive}},
       {.name = "noise",
        .value = Key::Special{[](ConfigMap* map, Imu* imu) {
          imu->noise = ReadImuNoise(map);
        }},
        .help = "as of a recording",
        .needed = true},
       {.name = "gyro_bias",
        .quantity = Quantity::kAngularRate,
        .value = Key::Vector{&Imu::gyro_bias},
        .help = "fixed part of the bias at the start"},
       {.name = "accel_bias",
        .quantity = Quantity::kAcceleration,
        .value = Key::Vector{&Imu::accel_bias},
        .help = "likewise"},
       {.name = "gyro_bias_sigma",
        .quantity = Quantity::kAngularRate,
        .value = Key::Spread{&Imu::gyro_bias_sigma},
        .help = "of its drawn part"},
       {.name = "accel_bias_sigma",
        .quantity = Quantity::kAcceleration,
        .value = Key::Spread{&Imu::accel_bias_sigma},
        .help = "likewise"},
       {.name = "gyro_scale",
        .value = Key::Vector{&Imu::gyro_scale},
        .help = "scale errors"},
       {.name = "accel_scale", .value = Key::Vector{&Imu::accel_scale}},
       {.name = "gyro_scale_sigma",
        .value = Key::Spread{&Imu::gyro_scale_sigma},
        .help = "of their drawn part, which is then estimated"},
       {.name = "accel_scale_sigma",
        .value = Key::Spread{&Imu::accel_scale_sigma},
        .help = "likewise"}}};
  return kTable;
}

void ReadOutages(ConfigMap* map, AidingModel* model) {
  for (ConfigMap& outage : map->Maps("outages")) {
    const double from = outage.Number("from", Quantity::kTime);
    const double to = outage.Number("to", Quantity::kTime);
    if (to <= from) outage.Fail("to", "must be later than from");
    outage.Finish();
    model->outages.push_back({from, to});
  }
}

const ConfigTable<AidingModel>& AidingModelTable() {
  using Key = ConfigKey<AidingModel>;
  static const ConfigTable<AidingModel> kTable = {
      "scenario: aiding",
      "NAME: a sensor each, with type and the keys of its type as in a "
      "recording, but for files; the errors of scale, mounting, lever arm, "
      "offset and time are drawn from the sigmas under estimate.",
      {{.name = "rate",
        .quantity = Quantity::kFrequency,
        .value = Key::Number{&AidingModel::rate_hz, KeyRange::kPositive}},
       {.name = "spacing",
        .quantity = Quantity::kLength,
        .value =
            Key::OptionalNumber{&AidingModel::spacing, KeyRange::kPositive},
        .help = "a measurement each time that so much of the path is behind, "
                "in place of a rate"},
       {.name = "time_offset",
        .value = Key::Special{[](ConfigMap* map, AidingModel* model) {
          model->sensor.time_offset =
              map->Number("time_offset", Quantity::kTime, 0.0);
        }},
        .fallback = "0 s"},
       {.name = "gate",
        .value = Key::Special{[](ConfigMap* map, AidingModel* model) {
          model->sensor.gate_probability = ReadGate(map);
          CompleteSettings(map, model);
        }},
        .help = "as of a recording"},
       {.name = "from",
        .value = Key::Special{[](ConfigMap* map, AidingModel* model) {
          model->from = map->OptionalNumber("from", Quantity::kTime)
                            .value_or(model->from);
        }},
        .help = "first stamp"},
       {.name = "to",
        .value = Key::Special{[](ConfigMap* map, AidingModel* model) {
          model->to =
              map->OptionalNumber("to", Quantity::kTime).value_or(model->to);
        }},
        .help = "last stamp"},
       {.name = "outages",
        .value = Key::Special{ReadOutages},
        .help = "list of {from, to} without measurements"}}};
  return kTable;
}

}  // namespace

void ReadImuModel(ConfigMap* top, Scenario* scenario) {
  ConfigMap map = top->Map("imu");
  SimulatedImu imu;
  ReadTable(ImuModelTable(), &map, &imu);
  map.Finish();
  scenario->imu = imu;
  scenario->imu_kind = imu.kind;
  scenario->imu_rate_hz = imu.rate_hz;
}

AidingModel ReadAidingModel(const std::string& name, ConfigMap* map) {
  if (name == "imu" || name == "truth") {
    map->Fail("type", "the name '" + name + "' is taken by another file");
  }
  AidingModel model(ReadKind(true, map));
  model.sensor.name = name;
  model.sigma.reset();
  ReadSensorKeys(true, map, &model);
  if (model.sensor.kind->states_sigma && !model.sigma) {
    map->Fail("sigma", "is missing");
  }
  ReadCalibrationSigmas(map, &model);
  model.draw_calibration = true;
  ReadTable(AidingModelTable(), map, &model);
  map->Finish();
  return model;
}

std::vector<KeySection> SimulatedSensorSections() {
  std::vector<KeySection> sections = {Documented(ImuModelTable())};
  KeySection& aiding = sections.emplace_back(Documented(AidingModelTable()));
  for (const SensorKind* kind : SensorKinds()) {
    for (const SensorKey& key : kind->keys) {
      if (!key.simulated) continue;
      aiding.keys.push_back({std::string(key.name), std::string(key.help), "0",
                             "type " + std::string(kind->name)});
    }
  }
  return sections;
}

}  // namespace hindsight
