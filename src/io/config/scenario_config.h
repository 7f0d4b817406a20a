#ifndef HINDSIGHT_IO_CONFIG_SCENARIO_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_SCENARIO_CONFIG_H_

#include <filesystem>
#include <string>
#include <vector>

#include "simulation/scenario.h"

namespace hindsight {

/// \file
/// Scenarios as YAML. Every physical value carries its unit; an unknown key is
/// an error. The keys are listed in docs/configuration.md.

/// "KEY=VALUE", made before the file is read (scenario_choices.h).
using ScenarioChanges = std::vector<std::string>;

/// Reads a scenario file. Throws InputError "file:line: ...".
Scenario LoadScenario(const std::string& path,
                      const ScenarioChanges& changes = {});

/// The files that LoadScenario reads: itself and its profile. Throws alike.
std::vector<std::filesystem::path> ScenarioFiles(const std::string& path);

/// Names of the scenarios that come with the program, the files of
/// data/scenarios.
std::vector<std::string> ScenarioNames();

/// The scenario of that name, else that of the file. Throws InputError for what
/// is neither, listing the names.
Scenario FindScenario(const std::string& name_or_path,
                      const ScenarioChanges& changes = {});

/// A motion profile: own CSV with the columns of truth (docs/formats.md),
/// or text without header, t [s], lat, lon [deg], h [m], v_n, v_e, v_d [m/s],
/// roll, pitch, heading [deg], comma-separated; plain or gzip. Throws
/// InputError naming file and line.
std::vector<ProfilePoint> ReadMotionProfile(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SCENARIO_CONFIG_H_
