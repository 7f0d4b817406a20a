#include "io/config/noise_keys.h"

#include <algorithm>
#include <vector>

#include "base/units.h"
#include "io/config/config_key.h"
#include "measurements/noise_kind.h"

namespace hindsight {
namespace {

/// Of sensors whose errors may be correlated, for messages.
std::string CorrelatedKinds() {
  std::vector<std::string_view> names;
  for (const SensorKind* kind : SensorKinds()) {
    if (kind->coloured) names.push_back(kind->name);
  }
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list += i == 0 ? "" : i + 1 == names.size() ? " and " : ", ";
    list += names[i];
  }
  return list;
}

std::vector<std::string> NoiseNames() {
  std::vector<std::string> names;
  for (const NoiseKind* kind : NoiseKinds()) names.emplace_back(kind->name);
  return names;
}

/// Refuses what does not go with an error state.
void CheckCorrelated(ConfigMap* map, ConfigMap* entry, const NoiseKind& kind,
                     const SensorKind& sensor) {
  const std::string name(kind.name);
  if (!sensor.coloured) {
    entry->Fail("model", name + " is for " + CorrelatedKinds() + " sensors");
  }
  for (const char* key : {"sigma", "sigma_scale", "correlations"}) {
    if (!map->Has(key)) continue;
    map->Fail(key, "does not go with noise of model " + name +
                       ", whose sigma and white take its place");
  }
}

/// A standard deviation so small that rounding would leave nothing positive
/// definite is refused.
double ReadSigma(ConfigMap* entry, const NoiseKey& key, const Sensor& sensor) {
  constexpr double kLeast = 1e-6;
  const std::string name(key.name);
  const Quantity quantity = *sensor.kind->coloured;
  const double sigma =
      key.fallback == nullptr
          ? entry->Positive(name, quantity)
          : entry->Positive(name, quantity, key.fallback(sensor));
  if (entry->Has(name) && sigma < kLeast) {
    entry->Fail(name,
                std::string("expected at least 1e-6 ") + SiUnit(quantity));
  }
  return sigma;
}

double ReadValue(ConfigMap* entry, const NoiseKey& key, const Sensor& sensor) {
  const std::string name(key.name);
  if (key.factor) {
    return ReadFactor(
        entry, name,
        key.fallback == nullptr ? "" : FormatNumber(key.fallback(sensor)));
  }
  if (!key.quantity) return ReadSigma(entry, key, sensor);
  if (key.fallback == nullptr) return entry->Positive(name, *key.quantity);
  return entry->Positive(name, *key.quantity, key.fallback(sensor));
}

}  // namespace

double ReadFactor(ConfigMap* map, const std::string& key,
                  const std::string& fallback) {
  const std::string text = map->Text(key, fallback);
  const auto number = ParseNumber(text);
  if (!number || !(*number > 0.0)) {
    map->Fail(key, "'" + text + "' is not a positive number");
  }
  return *number;
}

bool HasCorrelatedNoise(ConfigMap* map) {
  if (!map->Has("noise")) return false;
  const auto model = map->Map("noise").OptionalText("model");
  return std::any_of(NoiseKinds().begin(), NoiseKinds().end(),
                     [&model](const NoiseKind* kind) {
                       return model == kind->name && kind->evolution != nullptr;
                     });
}

void ReadNoise(ConfigMap* map, SensorSettings* settings) {
  if (!map->Has("noise")) return;
  Sensor* sensor = &settings->sensor;
  ConfigMap entry = map->Map("noise");
  const NoiseKind& kind =
      *NoiseKinds()[entry.Choice("model", NoiseNames(), std::nullopt)];
  sensor->noise.kind = &kind;
  if (sensor->noise.correlated()) {
    CheckCorrelated(map, &entry, kind, *sensor->kind);
  }
  for (const NoiseKey& key : kind.keys) {
    *key.at(*sensor) = ReadValue(&entry, key, *sensor);
  }
  if (kind.complete != nullptr) {
    if (const auto objection = kind.complete(sensor)) {
      entry.Fail(std::string(objection->key), std::string(objection->text));
    }
  }
  // The file need not state what is not used.
  if (sensor->noise.correlated()) {
    settings->sigma = Eigen::Vector3d::Constant(sensor->noise.white_sigma);
  }
  entry.Finish();
}

KeySection NoiseSection() {
  KeySection section = {
      "noise",
      "The map noise of an aiding stream. Models with a sigma are for " +
          CorrelatedKinds() + ".",
      {}};
  std::string models;
  for (const NoiseKind* kind : NoiseKinds()) {
    models += (models.empty() ? "" : "; ") + std::string(kind->name) + ": " +
              std::string(kind->help);
  }
  section.keys.push_back({"model", models, "needed"});
  for (const NoiseKind* kind : NoiseKinds()) {
    for (const NoiseKey& key : kind->keys) {
      section.keys.push_back(
          {std::string(key.name), std::string(key.help),
           key.fallback == nullptr ? "needed" : std::string(key.fallback_text),
           "model: " + std::string(kind->name)});
    }
  }
  return section;
}

}  // namespace hindsight
