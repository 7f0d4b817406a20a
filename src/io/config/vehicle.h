#ifndef HINDSIGHT_IO_CONFIG_VEHICLE_H_
#define HINDSIGHT_IO_CONFIG_VEHICLE_H_

#include <string>
#include <string_view>
#include <vector>

#include "io/config/config_map.h"

namespace hindsight {

/// A key that a kind of vehicle sets where the configuration does not.
struct VehicleChoice {
  std::string_view key;    ///< "stationary", "initial.speed_spread"
  std::string_view value;  ///< as YAML
  std::string_view why;    ///< the physical reason, a clause
};

/// What suits a kind of vehicle.
struct VehicleKind {
  std::string_view name;  ///< `vehicle` in configurations
  std::vector<VehicleChoice> choices;
};

/// The list of all, which the configuration, its help and docs/running.md walk.
const std::vector<VehicleKind>& VehicleKinds();
std::vector<std::string> VehicleNames();

/// Sets what the kind of `vehicle` chooses and the configuration does not say;
/// `note` becomes a clause on what was set, and what is kept. A constraint to the
/// wheels is not added beside an odometer or another such constraint. A name that
/// is none is left to the reader of the key.
ConfigMap::Edit SetVehicle(std::string* note);

/// The kinds, a line of text for each choice with its reason below it.
std::string VehicleHelp();
/// The kinds as a table of Markdown.
std::string VehicleMarkdown();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_VEHICLE_H_
