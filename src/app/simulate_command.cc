#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "app/command.h"
#include "app/flags.h"
#include "app/result_folder.h"
#include "app/study_cases.h"
#include "io/config/scenario_config.h"
#include "io/read/paths.h"
#include "io/write/dataset_writer.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Makes a recording with known truth: a vehicle's motion, the exact readings of
an IMU that moves so on the rotating Earth, and the errors of IMU and aiding
sensors, drawn from the seed. SCENARIO is the name of a built-in scenario
(--list) or a YAML file. The folder of --out gets config.yaml, imu.csv, a file
for each aiding sensor, truth.csv and manifest.json, the list of these, and
appears when it is complete; after Ctrl-C or on a full disk nothing stays. What
is in the way by then stays, and the recording is beside it as DIR.1.
)";

int ListScenarios() {
  for (const std::string& name : ScenarioNames()) {
    std::cout << name << "\n    " << FindScenario(name).description << "\n";
  }
  return kUsable;
}

/// Says that --duration goes beyond the end of the scenario, which lasts a sample's
/// interval less than its samples.
void NoteEnd(const Scenario& scenario, const Simulation& simulation) {
  const auto samples = static_cast<double>(simulation.sample_count());
  if (!IsGiven("duration") ||
      FLAGS_duration * scenario.imu_rate_hz <= samples) {
    return;
  }
  std::cout << fmt::format(
      "the scenario ends after {:.6g} s, before the {:.6g} s of --duration\n",
      (samples - 1.0) / scenario.imu_rate_hz, FLAGS_duration);
}

int Write(const Scenario& scenario, ResultFolder* folder) {
  Simulation simulation(scenario, FLAGS_seed);
  NoteEnd(scenario, simulation);
  WriteDataset(&simulation,
               [&](const std::string& name) { return folder->Path(name); });
  folder->Commit();
  const std::string config =
      (std::filesystem::path(FLAGS_out) / kDatasetConfigName).string();
  std::cout << "wrote the recording '" << scenario.name << "', seed "
            << FLAGS_seed << ", to " << FLAGS_out
            << "\nreconstruct it with: hindsight run " << config
            << " --out=results\n";
  return kUsable;
}

int Run(const std::vector<std::string>& arguments) {
  if (FLAGS_list) return ListScenarios();
  if (arguments.empty()) {
    throw UsageError("'simulate' needs a scenario ('--list' names them)");
  }
  if (FLAGS_out.empty()) {
    throw UsageError(
        "'simulate' needs --out=DIR, the folder for the recording");
  }
  Scenario scenario = FindScenario(arguments[0], ReadChanges());
  if (!FLAGS_profile.empty()) {
    scenario.profile = ReadMotionProfile(FLAGS_profile);
    scenario.name += "_profile";
  }
  if (IsGiven("duration")) {
    if (!(FLAGS_duration > 0.0)) {
      throw UsageError("--duration must be longer than 0 s");
    }
    scenario.duration = std::min(scenario.duration, FLAGS_duration);
    std::erase_if(scenario.injections, [&](const Injection& injection) {
      return injection.from >= scenario.duration;
    });
  }
  const auto inputs = [&] {
    ResultFolder::Paths files;
    if (IsFile(arguments[0])) files = ScenarioFiles(arguments[0]);
    if (!FLAGS_profile.empty()) files.emplace_back(FLAGS_profile);
    return files;
  };
  return WithResultFolder(
      {FLAGS_out, FLAGS_force, FLAGS_clean}, inputs,
      [&](ResultFolder* folder) { return Write(scenario, folder); });
}

}  // namespace

Command SimulateCommand() {
  return {
      .name = "simulate",
      .summary = "make a recording with known truth",
      .arguments = "SCENARIO",
      .help = kHelp,
      .flags = {{"out", "DIR", "folder for the recording (required)"},
                {"force", "",
                 "replace DIR if it holds nothing but an earlier\n"
                 "recording, by its manifest.json"},
                {"clean", "", "remove what killed calls left beside DIR"},
                {"seed", "N", "of the random errors, 0 or more (1)"},
                {"profile", "FILE",
                 "move as in FILE in place of the scenario's segments:\n"
                 "a truth.csv, or without header t, lat, lon, h, v north,\n"
                 "east, down, roll, pitch, heading in s, deg, m, m/s"},
                {"duration", "T", "end after T seconds (that of the scenario)"},
                {"set", "KEY=VALUE",
                 "change a key of the scenario, aiding.gnss.sigma='2 m',\n"
                 "or choose, errors=spikes; several times"},
                {"list", "", "list the built-in scenarios"}},
      .min_arguments = 0,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
