#include <array>
#include <cmath>

#include "base/units.h"
#include "io/config_streams.h"

namespace hindsight {

void RequireTurns(ConfigMap* map, const std::string& key,
                  const Eigen::Vector3d& angles) {
  if (angles.cwiseAbs().maxCoeff() <= 2.0 * kPi) return;
  map->Fail(key, "expected angles of -360 to 360 deg");
}

double ReadScale(ConfigMap* map) {
  const double scale = map->Number("scale", Quantity::kRatio, 0.0);
  if (scale <= -1.0) {
    map->Fail("scale",
              "expected more than -100 %: measured = (1 + scale) true");
  }
  return scale;
}

std::optional<Geodetic> ReadGeodetic(ConfigMap* map, const std::string& key) {
  if (!map->Has(key)) return std::nullopt;
  const std::vector<std::string> items = map->List(key);
  if (items.size() != 3) {
    map->Fail(key, "expected [latitude, longitude, height]");
  }
  constexpr std::array kUnits = {Quantity::kAngle, Quantity::kAngle,
                                 Quantity::kLength};
  std::array<double, 3> values;
  YAML::Node list(YAML::NodeType::Sequence);
  for (std::size_t i = 0; i < 3; ++i) {
    try {
      values[i] = ParseQuantity(items[i], kUnits[i]);
    } catch (const std::invalid_argument& error) {
      map->Fail(key, error.what());
    }
    list.push_back(FormatNumber(values[i]) + " " + SiUnit(kUnits[i]));
  }
  list.SetStyle(YAML::EmitterStyle::Flow);
  map->resolved()[key] = list;
  if (std::abs(values[0]) > kPi / 2.0) {
    map->Fail(key, "the latitude lies beyond 90 deg");
  }
  if (values[1] < -kPi || values[1] > 2.0 * kPi) {
    map->Fail(key, "the longitude lies beyond -180 to 360 deg");
  }
  return Geodetic{values[0], values[1], values[2]};
}

TruthFrame ReadTruthFrame(ConfigMap* truth) {
  TruthFrame frame;
  frame.axes = static_cast<TruthFrame::Axes>(
      truth->Choice("frame", {"ecef", "ned", "enu", "nwu"}, 0));
  frame.origin = ReadGeodetic(truth, "origin");
  if (frame.origin && frame.axes == TruthFrame::Axes::kEcef) {
    truth->Fail("origin", "does not go with the frame ecef");
  }
  frame.frame_to_body =
      truth->Choice("quaternion", {"body_to_frame", "frame_to_body"}, 0) == 1;
  return frame;
}

InitialState ReadInitialState(ConfigMap* top, bool* from_truth) {
  InitialState initial;
  initial.alignment =
      static_cast<AlignmentKind>(top->Choice("alignment", AlignmentNames(), 0));
  ConfigMap map = top->Map("initial");
  *from_truth = map.Choice("from", {"given", "truth"}, 0) == 1;
  if (*from_truth && !top->Has("truth")) {
    map.Fail("from", "there is no truth");
  }
  initial.t = map.OptionalNumber("time", Quantity::kTime);
  initial.position = ReadGeodetic(&map, "position");
  initial.v_n = map.OptionalVector("velocity", Quantity::kSpeed);
  initial.euler = map.OptionalVector("attitude", Quantity::kAngle);
  if (initial.euler) RequireTurns(&map, "attitude", *initial.euler);
  initial.heading = map.OptionalNumber("heading", Quantity::kAngle);
  if (initial.euler && initial.heading) {
    map.Fail("heading", "does not go with attitude, which holds it");
  }
  if (initial.alignment == AlignmentKind::kGiven && !initial.euler &&
      !initial.heading && !*from_truth) {
    top->Fail("alignment", "given needs initial.attitude or initial.heading");
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
