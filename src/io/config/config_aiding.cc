#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/config/noise_keys.h"
#include "io/config/sensor_keys.h"

namespace hindsight {
namespace {

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

RobustLoss ReadLoss(ConfigMap* map) {
  RobustLoss loss;
  if (!map->Has("loss")) return loss;
  ConfigMap entry = map->Map("loss");
  const std::size_t kind = entry.Choice(
      "kind", {"none", "huber", "cauchy", "tukey", "geman_mcclure"},
      std::nullopt);
  loss.kind = static_cast<RobustLoss::Kind>(kind);
  loss.scale = ReadFactor(&entry, "scale", FormatNumber(loss.scale));
  entry.Finish();
  return loss;
}

/// What is done with the standard deviations of the file.
void ReadSigmaScale(ConfigMap* map, SensorSettings* settings) {
  if (!settings->sensor.kind->states_sigma || HasCorrelatedNoise(map)) return;
  if (settings->sigma) {
    if (map->Has("sigma_scale")) {
      map->Fail("sigma_scale", "does not go with sigma");
    }
    return;
  }
  settings->sigma_scale = ReadFactor(map, "sigma_scale", "1");
  settings->use_correlations = map->Flag("correlations", true);
}

void ReadClock(ConfigMap* map, AidingConfig* config) {
  config->clock_of_truth = map->Is("time_offset", "truth");
  config->clock_unknown = map->Is("time_offset", "unknown");
  if (config->clock_of_truth || config->clock_unknown) return;
  config->settings.sensor.time_offset =
      map->Number("time_offset", Quantity::kTime, 0.0);
}

}  // namespace

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

void ReadCalibrationSigmas(ConfigMap* map, SensorSettings* settings) {
  ConfigMap estimate = map->Map("estimate");
  ReadEstimateKeys(&estimate, settings);
  if (settings->sensor.kind->has_clock && estimate.Has("time_offset")) {
    settings->sensor.time_offset_sigma =
        estimate.Positive("time_offset", Quantity::kTime);
  }
  estimate.Finish();
}

namespace {

/// With what its keys are read by.
struct AidingDraft : AidingConfig {
  std::filesystem::path folder;
  bool has_file() const { return !settings.sensor.kind->generated; }
};

/// The kind, and the keys of its stream.
void ReadType(ConfigMap* map, AidingDraft* aiding) {
  aiding->settings = SettingsOf(ReadKind(false, map));
  const SensorKind& kind = *aiding->settings.sensor.kind;
  if (aiding->has_file()) {
    aiding->source = ReadStreamSource(map, aiding->folder, kind.columns);
    return;
  }
  aiding->source.name = map->name();
  aiding->source.config_path = map->file();
  aiding->source.config_line = map->Line("rate");
}

/// The keys of the kind come before, since `sigma` is among them.
void ReadKindAndSigmas(ConfigMap* map, AidingDraft* aiding) {
  ReadSensorKeys(false, map, &aiding->settings);
  ReadSigmaScale(map, &aiding->settings);
}

const ConfigTable<AidingDraft>& AidingTable() {
  using Key = ConfigKey<AidingDraft>;
  static const ConfigTable<AidingDraft> kTable = {
      "aiding",
      "Besides the keys of a stream and those of its kind.",
      {{.name = "type",
        .value = Key::Special{ReadType},
        .help = "the kind of sensor",
        .needed = true},
       {.name = "accept_quality",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          if (!aiding->has_file()) return;
          aiding->settings.accept_quality = ReadQualities(map);
        }},
        .help = "values of the column quality that are used",
        .fallback = "all"},
       {.name = "every",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          if (!aiding->has_file() || !map->Has("every")) return;
          aiding->settings.every = map->Positive("every", Quantity::kTime);
        }},
        .help = "use one measurement in this time",
        .fallback = "all"},
       {.name = "on_repeat",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          if (!aiding->has_file()) return;
          aiding->source.drop_repeats =
              map->Choice("on_repeat", {"use", "drop"}, 0) == 1;
        }},
        .help =
            "a row whose measured values are all those of the row before: a "
            "receiver's last fix, written again",
        .fallback = "use"},
       {.name = "time_offset",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          if (aiding->has_file()) ReadClock(map, aiding);
        }},
        .help = "true time = stamp + offset; `truth`: that of the truth; "
                "`unknown`: the data tell, and it is estimated",
        .fallback = "0 s"},
       {.name = "sigma_scale",
        .value = Key::Special{ReadKindAndSigmas},
        .help = "multiplies the file's standard deviations",
        .fallback = "1"},
       {.name = "correlations",
        .value = Key::Special{},
        .help = "use the file's covariances",
        .fallback = "true"},
       {.name = "gate",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          aiding->settings.sensor.gate_probability = ReadGate(map);
        }},
        .help = "probability that a good measurement passes, or off",
        .fallback = "off"},
       {.name = "loss",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          aiding->settings.sensor.loss = ReadLoss(map);
        }},
        .help = "{kind: huber, cauchy, tukey or geman_mcclure, scale in "
                "standard deviations}",
        .fallback = "none"},
       {.name = "noise",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          ReadNoise(map, &aiding->settings);
        }},
        .help = "how its errors are distributed and correlated",
        .fallback = "{model: white}"},
       {.name = "estimate",
        .value = Key::Special{[](ConfigMap* map, AidingDraft* aiding) {
          ReadCalibrationSigmas(map, &aiding->settings);
        }},
        .help = "a priori sigmas of what is estimated; time_offset of those "
                "that have a clock"}}};
  return kTable;
}

}  // namespace

AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder) {
  AidingDraft aiding;
  aiding.folder = folder;
  ReadTable(AidingTable(), map, &aiding);
  aiding.settings.sensor.name = name;
  if (aiding.clock_unknown && aiding.settings.sensor.time_offset_sigma) {
    map->Fail("estimate",
              "time_offset does not go with `time_offset: unknown`, which is "
              "estimated as it is; expected a value of time_offset that the "
              "sigma belongs to, or no sigma");
  }
  CompleteSettings(map, &aiding.settings);
  map->Finish();
  return aiding;
}

KeySection AidingSection() { return Documented(AidingTable()); }

}  // namespace hindsight
