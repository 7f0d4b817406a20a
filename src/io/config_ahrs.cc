#include "io/config_streams.h"

namespace hindsight {
namespace {

/// The accelerometer rules keep so much.
constexpr int kMostSamples = 1000000;
constexpr double kMostSeconds = 3600.0;

double ReadNotNegative(ConfigMap* map, const std::string& key,
                       Quantity quantity, double fallback) {
  const double value = map->Number(key, quantity, fallback);
  if (value < 0.0) map->Fail(key, "must not be negative");
  return value;
}

}  // namespace

AhrsSettings ReadAhrs(ConfigMap* top) {
  AhrsSettings ahrs;
  ConfigMap map = top->Map("ahrs");
  const std::vector<std::string> rules = {"fixed", "gate", "held_gate",
                                          "adaptive", "smnc"};
  ahrs.rule = rules[map.Choice("rule", rules, 0)];
  ahrs.accel_sigma =
      map.Positive("accel_sigma", Quantity::kAcceleration, ahrs.accel_sigma);
  ahrs.gate = map.Positive("gate", Quantity::kAcceleration, ahrs.gate);
  ahrs.lambda = ReadNotNegative(&map, "lambda", Quantity::kRatio, ahrs.lambda);
  if (map.Has("samples") && map.Has("seconds")) {
    map.Fail("seconds", "does not go with samples");
  }
  if (map.Has("seconds")) {
    ahrs.seconds = map.Positive("seconds", Quantity::kTime);
    if (*ahrs.seconds > kMostSeconds) {
      map.Fail("seconds", "expected at most 3600 s");
    }
  } else {
    ahrs.samples = map.Integer("samples", ahrs.samples);
    if (ahrs.samples > kMostSamples) {
      map.Fail("samples", "expected at most 1000000");
    }
  }
  if (map.Has("low_pass")) {
    ahrs.low_pass = ReadNotNegative(&map, "low_pass", Quantity::kTime, 0.0);
  }
  ahrs.correlation_time = ReadNotNegative(
      &map, "correlation_time", Quantity::kTime, ahrs.correlation_time);
  ahrs.rest_sigma = ReadNotNegative(&map, "rest_sigma", Quantity::kAngularRate,
                                    ahrs.rest_sigma);
  ahrs.reject_disturbances =
      map.Flag("reject_disturbances", ahrs.reject_disturbances);
  ahrs.survey = map.Flag("survey", ahrs.survey);
  ahrs.room = map.Positive("room", Quantity::kLength, ahrs.room);
  ahrs.room_speed =
      map.Positive("room_speed", Quantity::kSpeed, ahrs.room_speed);
  map.Finish();
  return ahrs;
}

}  // namespace hindsight
