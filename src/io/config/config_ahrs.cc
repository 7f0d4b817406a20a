#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/config/config_key.h"
#include "io/config/config_streams.h"

namespace hindsight {
namespace {

/// The accelerometer rules keep so much.
constexpr int kMostSamples = 1000000;
constexpr double kMostSeconds = 3600.0;

const std::vector<std::string>& RuleNames() {
  static const std::vector<std::string> kNames = {"fixed", "gate", "held_gate",
                                                  "adaptive", "smnc"};
  return kNames;
}

/// Whether the rule has a use for `key`. Throws InputError where it is given
/// and has none.
bool IsUsed(const std::string& key, const std::vector<std::string>& rules,
            const AhrsSettings& ahrs, ConfigMap* map) {
  const bool used =
      std::find(rules.begin(), rules.end(), ahrs.rule) != rules.end();
  if (!used && map->Has(key)) {
    map->Fail(key, fmt::format("has no use with rule: {}; expected it beside "
                               "rule: {}",
                               ahrs.rule, fmt::join(rules, " or ")));
  }
  return used;
}

void ReadGateLimit(ConfigMap* map, AhrsSettings* ahrs) {
  if (!IsUsed("gate", {"gate", "held_gate"}, *ahrs, map)) return;
  ahrs->gate = map->Positive("gate", Quantity::kAcceleration, ahrs->gate);
}

void ReadLambda(ConfigMap* map, AhrsSettings* ahrs) {
  if (!IsUsed("lambda", {"adaptive", "smnc"}, *ahrs, map)) return;
  ahrs->lambda = map->Number("lambda", Quantity::kRatio, ahrs->lambda);
  if (!(ahrs->lambda >= 0.0)) map->Fail("lambda", "must not be negative");
}

/// As many as `seconds` say, where that is there.
void ReadSamples(ConfigMap* map, AhrsSettings* ahrs) {
  const std::vector<std::string> rules = {"held_gate", "adaptive", "smnc"};
  const bool samples = IsUsed("samples", rules, *ahrs, map);
  const bool seconds = IsUsed("seconds", rules, *ahrs, map);
  if (!samples || !seconds) return;
  if (map->Has("samples") && map->Has("seconds")) {
    map->Fail("seconds", "does not go with samples");
  }
  if (map->Has("seconds")) {
    ahrs->seconds = map->Positive("seconds", Quantity::kTime);
    if (*ahrs->seconds > kMostSeconds) {
      map->Fail("seconds", "expected at most 3600 s");
    }
    return;
  }
  ahrs->samples = map->Integer("samples", ahrs->samples);
  if (ahrs->samples > kMostSamples) {
    map->Fail("samples", "expected at most 1000000");
  }
}

const ConfigTable<AhrsSettings>& AhrsTable() {
  using Key = ConfigKey<AhrsSettings>;
  static const ConfigTable<AhrsSettings> kTable = {
      "ahrs",
      "Methods for attitude alone. Of `stationary` the smoother takes where an "
      "IMU is quiet. The gyros' scale factors have the sigma of "
      "imu.estimate.gyro_scale, or 0.4 %.",
      {{.name = "rule",
        .value = Key::Word{RuleNames(),
                           [](const AhrsSettings& ahrs) {
                             const auto& names = RuleNames();
                             return static_cast<std::size_t>(
                                 std::find(names.begin(), names.end(),
                                           ahrs.rule) -
                                 names.begin());
                           },
                           [](AhrsSettings& ahrs, std::size_t word) {
                             ahrs.rule = RuleNames()[word];
                           }},
        .help = "of the accelerometer"},
       {.name = "accel_sigma",
        .quantity = Quantity::kAcceleration,
        .value = Key::Number{&AhrsSettings::accel_sigma, KeyRange::kPositive},
        .help = "of the accelerometer as a tilt sensor"},
       {.name = "gate",
        .quantity = Quantity::kAcceleration,
        .value = Key::Special{ReadGateLimit},
        .help = "beyond which rule gate or held_gate does not use a reading",
        .fallback = "0.88 m/s^2"},
       {.name = "lambda",
        .value = Key::Special{ReadLambda},
        .help = "of rule smnc; adaptive takes it N + 1 times",
        .fallback = "0.05"},
       {.name = "samples",
        .value = Key::Special{ReadSamples},
        .help = "N of rule smnc, held_gate or adaptive",
        .fallback = "4"},
       {.name = "seconds",
        .value = Key::Special{},
        .help = "in place of samples"},
       {.name = "low_pass",
        .quantity = Quantity::kTime,
        .value = Key::OptionalNumber{&AhrsSettings::low_pass,
                                     KeyRange::kNotNegative},
        .help = "time constant",
        .fallback = "1.5 s with the fixed rule, else 0 s"},
       {.name = "correlation_time",
        .quantity = Quantity::kTime,
        .value = Key::Number{&AhrsSettings::correlation_time,
                             KeyRange::kNotNegative},
        .help = "of the errors of accelerometer and magnetometer"},
       {.name = "rest_sigma",
        .quantity = Quantity::kAngularRate,
        .value = Key::Number{&AhrsSettings::rest_sigma, KeyRange::kNotNegative},
        .help = "of the gyro bias as one sample at rest reads it; 0: rest is "
                "no knowledge",
        .fallback = "1 deg/s"},
       {.name = "reject_disturbances",
        .value = Key::Flag{&AhrsSettings::reject_disturbances},
        .help = "by norm and dip of the field"},
       {.name = "survey",
        .value = Key::Flag{&AhrsSettings::survey},
        .help = "the smoother finds field and hard iron of the whole recording "
                "first"}}};
  return kTable;
}

}  // namespace

AhrsSettings ReadAhrs(ConfigMap* top) {
  AhrsSettings ahrs;
  ConfigMap map = top->Map("ahrs");
  ReadTable(AhrsTable(), &map, &ahrs);
  map.Finish();
  return ahrs;
}

KeySection AhrsSection() { return Documented(AhrsTable()); }

}  // namespace hindsight
