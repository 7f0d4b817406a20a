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

/// As many as `seconds` say, where that is there.
void ReadSamples(ConfigMap* map, AhrsSettings* ahrs) {
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
        .value = Key::Number{&AhrsSettings::gate, KeyRange::kPositive},
        .help = "beyond which gate and held_gate do not use a reading"},
       {.name = "lambda",
        .value = Key::Number{&AhrsSettings::lambda, KeyRange::kNotNegative},
        .help = "of the adaptive rule"},
       {.name = "samples",
        .value = Key::Special{ReadSamples},
        .help = "N of smnc and held_gate",
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
