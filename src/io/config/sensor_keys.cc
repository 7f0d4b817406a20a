#include "io/config/sensor_keys.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/config/config_key.h"
#include "io/config/config_streams.h"

namespace hindsight {
namespace {

constexpr std::string_view kEstimate = "estimate.";

/// Reads one value into the settings; `name` is the last part of the key.
class ValueReader {
 public:
  ValueReader(const SensorKey& key, std::string name, bool simulated,
              ConfigMap* map, SensorSettings* settings)
      : key_(key),
        name_(std::move(name)),
        simulated_(simulated),
        map_(*map),
        settings_(*settings) {}

  void Read() {
    std::visit([this](const auto& value) { Take(value); }, key_.value);
  }

 private:
  double Checked(KeyRange range) {
    return ReadInRange(&map_, name_, key_.quantity, range);
  }

  void Take(const SensorKey::Number& number) {
    double& value = *number.at(settings_);
    if (map_.Has(name_)) {
      value = Checked(number.range);
    } else if (LiesIn(number.range, value)) {
      map_.Resolve(name_, value, key_.quantity);
    }
  }
  void Take(const SensorKey::OptionalNumber& number) {
    if (map_.Has(name_)) *number.at(settings_) = Checked(number.range);
  }
  void Take(const SensorKey::Vector& vector) {
    Eigen::Vector3d& value = *vector.at(settings_);
    value = map_.Vector(name_, key_.quantity, value);
    RequireOnBoard(map_, name_, key_.quantity, value);
  }
  void Take(const SensorKey::OptionalSigmas& sigmas) {
    auto& value = *sigmas.at(settings_);
    if (map_.Has(name_)) {
      if (sigmas.one) {
        value.emplace().setConstant(map_.Positive(name_, key_.quantity));
      } else {
        value = map_.OptionalSigma(name_, key_.quantity);
      }
    } else if (value) {
      value = map_.Vector(name_, key_.quantity, *value);
    }
  }
  void Take(const SensorKey::SidesSigma& sides) {
    const std::vector<std::string> items = map_.List(name_);
    if (items.size() != 2) map_.Fail(name_, "expected [side, down]");
    std::vector<double> sigma;
    try {
      sigma = ParseQuantities(items[0] + ", " + items[1], key_.quantity);
    } catch (const std::invalid_argument& error) {
      map_.Fail(name_, error.what());
    }
    if (!(sigma[0] > 0.0 && sigma[1] > 0.0)) {
      map_.Fail(name_, "expected standard deviations greater than zero");
    }
    *sides.at(settings_) = Eigen::Vector3d(1.0, sigma[0], sigma[1]);
  }
  void Take(const SensorKey::Mounting& mounting) {
    Sensor& sensor = settings_.sensor;
    if (mounting.may_be_unknown && !simulated_ && map_.IsScalar(name_)) {
      map_.Choice(name_, {"unknown"}, std::nullopt);
      sensor.mounting_unknown = true;
      sensor.mounting_sigma.emplace().setConstant(kFoundMountingSigma);
      return;
    }
    sensor.q_sb = ReadSensorMounting(&map_);
  }
  void Take(const SensorKey::Axes&) { settings_.C_bs = ReadMounting(&map_); }
  void Take(const SensorKey::Place& place) {
    if (const auto geodetic = ReadGeodetic(&map_, name_)) {
      *place.at(settings_) = EcefFromGeodetic(*geodetic);
    }
  }
  void Take(const SensorKey::Whole& whole) {
    if (!map_.Has(name_)) return;
    const int value = map_.Integer(name_, 0);
    if (value < whole.least || value > whole.most) {
      map_.Fail(name_, "expected a whole number from " +
                           std::to_string(whole.least) + " to " +
                           std::to_string(whole.most));
    }
    *whole.at(settings_) = value;
  }
  void Take(const SensorKey::Word& word) {
    const std::vector<std::string> words(word.words.begin(), word.words.end());
    word.set(settings_, map_.Choice(name_, words, word.get(settings_)));
  }

  const SensorKey& key_;
  const std::string name_;
  const bool simulated_;
  ConfigMap& map_;
  SensorSettings& settings_;
};

void ReadKey(const SensorKey& key, const std::string& name, bool needed,
             bool simulated, ConfigMap* map, SensorSettings* settings) {
  if (needed && !map->Has(name)) map->Fail(name, std::string(key.missing));
  ValueReader(key, name, simulated, map, settings).Read();
}

bool IsNeeded(const SensorKey& key, const SensorSettings& settings) {
  return key.needed != nullptr && key.needed(settings);
}

/// The keys "prefix.name" from `first` on, up to the first of another map.
std::size_t ReadGroup(const SensorKeys& keys, std::size_t first, bool simulated,
                      ConfigMap* map, SensorSettings* settings) {
  const std::string prefix(
      keys[first].name.substr(0, keys[first].name.find('.')));
  std::size_t end = first;
  while (end < keys.size() && keys[end].name.starts_with(prefix + ".")) ++end;
  if (!map->Has(prefix)) {
    if (IsNeeded(keys[first], *settings)) {
      map->Fail(prefix, std::string(keys[first].missing));
    }
    return end;
  }
  ConfigMap group = map->Map(prefix);
  for (std::size_t i = first; i < end; ++i) {
    ReadKey(keys[i], std::string(keys[i].name.substr(prefix.size() + 1)),
            i == first, simulated, &group, settings);
  }
  group.Finish();
  return end;
}

}  // namespace

void ReadSensorKeys(bool simulated, ConfigMap* map, SensorSettings* settings) {
  const SensorKeys& keys = settings->sensor.kind->keys;
  for (std::size_t i = 0; i < keys.size();) {
    const SensorKey& key = keys[i];
    // Simulated readings are in body axes.
    const bool turned = std::holds_alternative<SensorKey::Axes>(key.value);
    const bool skipped = key.name.starts_with(kEstimate) ||
                         (simulated && turned) ||
                         (key.simulated && !simulated) ||
                         (key.applies != nullptr && !key.applies(*settings));
    if (skipped) {
      ++i;
    } else if (key.name.find('.') != key.name.npos) {
      i = ReadGroup(keys, i, simulated, map, settings);
    } else {
      ReadKey(key, std::string(key.name), IsNeeded(key, *settings), simulated,
              map, settings);
      ++i;
    }
  }
}

void ReadEstimateKeys(ConfigMap* estimate, SensorSettings* settings) {
  for (const SensorKey& key : settings->sensor.kind->keys) {
    if (!key.name.starts_with(kEstimate)) continue;
    if (key.applies != nullptr && !key.applies(*settings)) continue;
    ReadKey(key, std::string(key.name.substr(kEstimate.size())), false, false,
            estimate, settings);
  }
}

void CompleteSettings(ConfigMap* map, SensorSettings* settings) {
  const auto complete = settings->sensor.kind->complete;
  if (complete == nullptr) return;
  if (const auto objection = complete(settings)) {
    map->Fail(std::string(objection->key), std::string(objection->text));
  }
}

const SensorKind& ReadKind(bool simulated, ConfigMap* map) {
  std::vector<const SensorKind*> kinds;
  std::vector<std::string> names;
  for (const SensorKind* kind : SensorKinds()) {
    if (simulated ? kind->perfect == nullptr : !kind->configured) continue;
    kinds.push_back(kind);
    names.emplace_back(kind->name);
  }
  return *kinds[map->Choice("type", names, std::nullopt)];
}

}  // namespace hindsight
