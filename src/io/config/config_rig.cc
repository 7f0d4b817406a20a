#include <array>
#include <cmath>

#include "base/units.h"
#include "io/config/config_streams.h"

namespace hindsight {

void RequireTurns(ConfigMap* map, const std::string& key,
                  const Eigen::Vector3d& angles) {
  if (angles.cwiseAbs().maxCoeff() <= 2.0 * kPi) return;
  map->Fail(key, "expected angles of -360 to 360 deg");
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
  const Geodetic place{values[0], values[1], values[2]};
  if (const auto why = WhyNotNearEarth(place)) map->Fail(key, *why);
  return place;
}

namespace {

/// InitialState and where it comes from.
struct StartConfig : InitialState {
  bool from_truth = false;
};

ConfigKey<StartConfig> SigmaOf(
    std::string_view name, Quantity quantity,
    std::optional<Eigen::Vector3d> StartConfig::*at) {
  return {.name = name,
          .quantity = quantity,
          .value = ConfigKey<StartConfig>::OptionalSigma{at},
          .help = "a priori sigma: three, or one for all"};
}

const ConfigTable<StartConfig>& InitialTable() {
  using Key = ConfigKey<StartConfig>;
  static const ConfigTable<StartConfig> kTable = {
      "initial",
      "Without a time a given position, velocity or attitude is that of the "
      "first IMU sample. What is absent is found by alignment.",
      {{.name = "from",
        .value = Key::Word{{"given", "truth"},
                           [](const StartConfig& start) {
                             return std::size_t{start.from_truth ? 1U : 0U};
                           },
                           [](StartConfig& start, std::size_t word) {
                             start.from_truth = word == 1;
                           }},
        .help = "time, position, velocity and attitude that are absent are the "
                "truth's at its first point inside the record"},
       {.name = "time",
        .quantity = Quantity::kTime,
        .value = Key::OptionalNumber{&StartConfig::t},
        .help = "at which the values hold"},
       {.name = "position",
        .value = Key::Place{&StartConfig::position},
        .help = "[lat, lon, h]"},
       {.name = "velocity",
        .quantity = Quantity::kSpeed,
        .value = Key::OptionalVector{&StartConfig::v_n},
        .help = "north, east, down"},
       {.name = "attitude",
        .quantity = Quantity::kAngle,
        .value = Key::Special{[](ConfigMap* map, StartConfig* start) {
          start->euler = map->OptionalVector("attitude", Quantity::kAngle);
          if (start->euler) RequireTurns(map, "attitude", *start->euler);
        }},
        .help = "roll, pitch, heading"},
       {.name = "heading",
        .value = Key::Special{[](ConfigMap* map, StartConfig* start) {
          start->heading = map->OptionalNumber("heading", Quantity::kAngle);
          if (!start->euler || !start->heading) return;
          map->Fail("heading", "does not go with attitude, which holds it");
        }},
        .help = "alone"},
       {.name = "gyro_bias",
        .quantity = Quantity::kAngularRate,
        .value = Key::Vector{&StartConfig::gyro_bias},
        .help = "measured minus true, body axes"},
       {.name = "accel_bias",
        .quantity = Quantity::kAcceleration,
        .value = Key::Vector{&StartConfig::accel_bias},
        .help = "measured minus true, body axes"},
       SigmaOf("position_sigma", Quantity::kLength,
               &StartConfig::position_sigma),
       SigmaOf("velocity_sigma", Quantity::kSpeed,
               &StartConfig::velocity_sigma),
       {.name = "speed_spread",
        .quantity = Quantity::kSpeed,
        .value = Key::Number{&StartConfig::speed_spread, KeyRange::kPositive},
        .help = "a priori sigma of the velocity that nothing tells: neither "
                "velocity, rest nor a sensor"},
       SigmaOf("attitude_sigma", Quantity::kAngle,
               &StartConfig::attitude_sigma),
       SigmaOf("gyro_bias_sigma", Quantity::kAngularRate,
               &StartConfig::gyro_bias_sigma),
       SigmaOf("accel_bias_sigma", Quantity::kAcceleration,
               &StartConfig::accel_bias_sigma)}};
  return kTable;
}

ConfigKey<StationaryOptions> ThresholdOf(std::string_view name,
                                         Quantity quantity,
                                         double StationaryOptions::*at,
                                         std::string_view help) {
  return {
      .name = name,
      .quantity = quantity,
      .value = ConfigKey<StationaryOptions>::Number{at, KeyRange::kPositive},
      .help = help};
}

const ConfigTable<StationaryOptions>& StationaryTable() {
  using Options = StationaryOptions;
  static const ConfigTable<Options> kTable = {
      "stationary",
      "Thresholds of standstill.",
      {ThresholdOf("window", Quantity::kTime, &Options::window,
                   "over which readings are judged"),
       ThresholdOf("gyro_threshold", Quantity::kAngularRate,
                   &Options::gyro_threshold, "standard deviation at rest"),
       ThresholdOf("accel_threshold", Quantity::kAcceleration,
                   &Options::accel_threshold, "standard deviation at rest"),
       ThresholdOf("velocity_sigma", Quantity::kSpeed, &Options::velocity_sigma,
                   "of the zero velocity"),
       ThresholdOf("rate_sigma", Quantity::kAngularRate, &Options::rate_sigma,
                   "of the zero angular rate")}};
  return kTable;
}

const ConfigTable<Omission>& OmitTable() {
  using Key = ConfigKey<Omission>;
  static const ConfigTable<Omission> kTable = {
      "omit",
      "A span of a sensor's measurements that are neither used nor judged.",
      {{.name = "sensor",
        .value = Key::Text{&Omission::sensor},
        .help = "name of a stream or kind of sensor",
        .needed = true},
       {.name = "from",
        .quantity = Quantity::kTime,
        .value = Key::Number{&Omission::from},
        .help = "since the data set's epoch",
        .needed = true},
       {.name = "to",
        .quantity = Quantity::kTime,
        .value = Key::Number{&Omission::to},
        .help = "the same; not included",
        .needed = true}}};
  return kTable;
}

const ConfigTable<Withholding>& WithholdTable() {
  using Key = ConfigKey<Withholding>;
  static const ConfigTable<Withholding> kTable = {
      "withhold",
      "Outage k starts at first fix + from + k every and lasts length. Without "
      "from it starts at first fix + (k + 1) every, of the first fix that the "
      "IMU covers.",
      {{.name = "sensor",
        .value = Key::Text{&Withholding::sensor},
        .help = "name of a stream or kind of sensor",
        .needed = true},
       {.name = "every",
        .quantity = Quantity::kTime,
        .value = Key::Number{&Withholding::every, KeyRange::kPositive},
        .help = "from start to start",
        .needed = true},
       {.name = "length",
        .quantity = Quantity::kTime,
        .value = Key::Number{&Withholding::length, KeyRange::kPositive},
        .help = "of an outage",
        .needed = true},
       {.name = "from",
        .quantity = Quantity::kTime,
        .value = Key::OptionalNumber{&Withholding::from},
        .help = "of the first start behind the stream's first fix",
        .fallback = "-"}}};
  return kTable;
}

const ConfigTable<Dataset>& NodesTable() {
  using Key = ConfigKey<Dataset>;
  static const ConfigTable<Dataset> kTable = {
      "nodes",
      "",
      {{.name = "max_spacing",
        .quantity = Quantity::kTime,
        .value = Key::Number{&Dataset::max_node_spacing, KeyRange::kPositive},
        .help = "longest interval between states"}}};
  return kTable;
}

}  // namespace

InitialState ReadInitialState(ConfigMap* top, bool* from_truth) {
  StartConfig start;
  start.alignment =
      static_cast<AlignmentKind>(top->Choice("alignment", AlignmentNames(), 0));
  ConfigMap map = top->Map("initial");
  ReadTable(InitialTable(), &map, &start);
  *from_truth = start.from_truth;
  if (start.from_truth && !top->Has("truth")) {
    map.Fail("from", "there is no truth");
  }
  if (start.alignment == AlignmentKind::kGiven && !start.euler &&
      !start.heading && !start.from_truth) {
    top->Fail("alignment", "given needs initial.attitude or initial.heading");
  }
  map.Finish();
  return start;
}

StationaryOptions ReadStationary(ConfigMap* top) {
  StationaryOptions options;
  const bool is_map = top->IsMap("stationary");
  if (!is_map && top->Choice("stationary", {"off", "on"}, 0) == 0) {
    return options;
  }
  ConfigMap map = is_map ? top->Map("stationary") : top->Defaults("stationary");
  options.enabled = true;
  ReadTable(StationaryTable(), &map, &options);
  map.Finish();
  return options;
}

std::vector<Omission> ReadOmissions(ConfigMap* top) {
  std::vector<Omission> omissions;
  for (ConfigMap& map : top->Maps("omit")) {
    Omission omission;
    ReadTable(OmitTable(), &map, &omission);
    if (!(omission.to > omission.from)) {
      map.Fail("to", "must lie behind from");
    }
    map.Finish();
    omissions.push_back(omission);
  }
  return omissions;
}

std::vector<Withholding> ReadWithholdings(ConfigMap* top) {
  std::vector<Withholding> withholdings;
  for (ConfigMap& map : top->Maps("withhold")) {
    Withholding withholding;
    ReadTable(WithholdTable(), &map, &withholding);
    if (withholding.length > withholding.every) {
      map.Fail("length", "must not be longer than every");
    }
    map.Finish();
    withholdings.push_back(withholding);
  }
  return withholdings;
}

void ReadNodes(ConfigMap* top, double* max_spacing) {
  ConfigMap map = top->Map("nodes");
  Dataset nodes;
  nodes.max_node_spacing = *max_spacing;
  ReadTable(NodesTable(), &map, &nodes);
  *max_spacing = nodes.max_node_spacing;
  map.Finish();
}

std::vector<KeySection> StartSections() {
  return {Documented(InitialTable()), Documented(StationaryTable()),
          Documented(WithholdTable()), Documented(OmitTable()),
          Documented(NodesTable())};
}

Eigen::Quaterniond ReadSensorMounting(ConfigMap* map) {
  const Eigen::Vector3d euler =
      map->Vector("mounting", Quantity::kAngle, Eigen::Vector3d::Zero());
  RequireTurns(map, "mounting", euler);
  return QuaternionFromEuler(euler.x(), euler.y(), euler.z());
}

}  // namespace hindsight
