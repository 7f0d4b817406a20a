#include "io/config/vehicle.h"

#include <algorithm>
#include <optional>

namespace hindsight {
namespace {

constexpr std::string_view kRestOfWheels =
    "brakes hold it, and it stands on the ground";
constexpr std::string_view kNoRest =
    "what is quiet may still move, which an IMU does not feel";

/// "aiding.wheels" as "aiding" and "wheels"; the second is empty if there is no
/// dot.
std::pair<std::string, std::string> SplitKey(std::string_view key) {
  const std::size_t dot = key.find('.');
  if (dot == key.npos) return {std::string(key), ""};
  return {std::string(key.substr(0, dot)), std::string(key.substr(dot + 1))};
}

bool ConstrainsWheels(const YAML::Node& aiding) {
  if (!aiding.IsMap()) return false;
  return std::any_of(aiding.begin(), aiding.end(), [](const auto& stream) {
    if (!stream.second.IsMap()) return false;
    const YAML::Node type = stream.second["type"];
    return type && type.IsScalar() &&
           (type.Scalar() == "odometer" || type.Scalar() == "non_holonomic");
  });
}

/// Sets it, and gives the key that it has; "" if the configuration says it
/// itself, or cannot take it. A stream of that name which is something else
/// leaves the constraint another name.
std::string Set(const VehicleChoice& choice, YAML::Node* top) {
  auto [map, key] = SplitKey(choice.key);
  const YAML::Node value = YAML::Load(std::string(choice.value));
  YAML::Node at = (*top)[map];
  if (key.empty()) {
    if (at) return "";
    (*top)[map] = value;
    return map;
  }
  if (!at || at.IsNull()) {
    (*top)[map] = YAML::Node(YAML::NodeType::Map);
    at = (*top)[map];
  }
  if (!at.IsMap()) return "";
  if (map == "aiding") {
    if (ConstrainsWheels(at)) return "";
    while (at[key]) key += "_2";
  }
  if (at[key]) return "";
  at[key] = value;
  return map + "." + key;
}

}  // namespace

const std::vector<VehicleKind>& VehicleKinds() {
  static const std::vector<VehicleKind> kKinds = {
      {"car",
       {{"stationary", "on", kRestOfWheels},
        {"aiding.wheels",
         "{type: non_holonomic, rate: 1 Hz, sigma: [0.05, 0.1 m/s], "
         "level_on_average: 1 deg, estimate: {mounting: 10 deg, "
         "lever_arm: 1 m}}",
         "tyres slip to the side by centimetres a second and springs give; "
         "roads are level but for their camber"},
        {"initial.speed_spread", "15 m/s", "of traffic"}}},
      {"rail",
       {{"stationary", "on", kRestOfWheels},
        {"aiding.wheels",
         "{type: non_holonomic, rate: 1 Hz, sigma: [0.03, 0.05 m/s], "
         "level_on_average: 3 deg, estimate: {mounting: 10 deg, "
         "lever_arm: 1 m}}",
         "flanges leave a few millimetres, bogies sway; curves are canted by "
         "up to 6 deg"},
        {"initial.speed_spread", "30 m/s", "of trains"}}},
      {"boat",
       {{"stationary", "off", kNoRest},
        {"initial.speed_spread", "5 m/s",
         "of boats; current and wind drift "
         "them to any side"}}},
      {"drone",
       {{"stationary", "off", kNoRest},
        {"initial.speed_spread", "10 m/s", "of multirotors, to any side"}}},
      {"hand",
       {{"stationary", "off", kNoRest},
        {"initial.speed_spread", "1 m/s", "of a hand, or who carries it"}}},
      {"foot",
       {{"stationary",
         "{window: 0.15 s, gyro_threshold: 0.5 rad/s, accel_threshold: 0.33 "
         "m/s^2, velocity_sigma: 5 cm/s, rate_sigma: 0.5 rad/s}",
         "the sole stands for a few tenths of a second each step, and rolls"},
        {"initial.speed_spread", "1.5 m/s", "of walking"}}},
      {"underwater",
       {{"stationary", "off", kNoRest},
        {"initial.speed_spread", "1.5 m/s", "of survey vehicles"}}}};
  return kKinds;
}

std::vector<std::string> VehicleNames() {
  std::vector<std::string> names;
  for (const VehicleKind& kind : VehicleKinds()) names.emplace_back(kind.name);
  return names;
}

ConfigMap::Edit SetVehicle(std::string* note) {
  return [note](YAML::Node* top) {
    const YAML::Node name = (*top)["vehicle"];
    if (!name || !name.IsScalar()) return;
    const auto kind = std::find_if(
        VehicleKinds().begin(), VehicleKinds().end(),
        [&](const VehicleKind& known) { return known.name == name.Scalar(); });
    if (kind == VehicleKinds().end()) return;
    std::string set;
    std::string kept;
    for (const VehicleChoice& choice : kind->choices) {
      const std::string key = Set(choice, top);
      std::string* list = key.empty() ? &kept : &set;
      *list += (list->empty() ? "" : "; ") +
               (key.empty() ? std::string(choice.key)
                            : key + ": " + std::string(choice.value));
    }
    *note = "vehicle " + std::string(kind->name) + " sets " +
            (set.empty() ? "nothing" : set) +
            (kept.empty() ? "" : "; the configuration has its own of " + kept);
  };
}

std::string VehicleHelp() {
  std::string text =
      "What `vehicle: NAME` of a configuration sets where it says nothing "
      "itself.\n";
  for (const VehicleKind& kind : VehicleKinds()) {
    text += "\n  " + std::string(kind.name) + "\n";
    for (const VehicleChoice& choice : kind.choices) {
      text += "    " + std::string(choice.key) + ": " +
              std::string(choice.value) + "\n        " +
              std::string(choice.why) + "\n";
    }
  }
  return text;
}

std::string VehicleMarkdown() {
  std::string text = "| vehicle | sets | because |\n|---|---|---|\n";
  for (const VehicleKind& kind : VehicleKinds()) {
    for (const VehicleChoice& choice : kind.choices) {
      text += "| `" + std::string(kind.name) + "` | `" +
              std::string(choice.key) + ": " + std::string(choice.value) +
              "` | " + std::string(choice.why) + " |\n";
    }
  }
  return text;
}

}  // namespace hindsight
