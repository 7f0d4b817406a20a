#include "io/config/scenario_config.h"

#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "io/config/config_streams.h"
#include "io/config/injection_text.h"
#include "io/config/scenario_choices.h"
#include "io/config/scenario_keys.h"
#include "io/config/scenario_texts.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

/// Sigmas greater than zero.
Eigen::Vector3d NeededSigma(ConfigMap* map, const char* key,
                            Quantity quantity) {
  const auto sigma = map->OptionalSigma(key, quantity);
  if (!sigma) map->Fail(key, "is missing");
  return *sigma;
}

void ReadAttitudeErrors(ConfigMap* map, StartErrors* errors) {
  const bool tilted = map->Has("tilt") || map->Has("heading");
  if (tilted) {
    BadStart& bad = errors->bad_attitude.emplace();
    for (const auto& [key, value] :
         {std::pair("tilt", &bad.tilt), std::pair("heading", &bad.heading)}) {
      *value = map->Positive(key, Quantity::kAngle);
      if (*value > kPi) map->Fail(key, "expected at most 180 deg");
    }
  }
  const bool given = map->Has("velocity") || map->Has("attitude");
  errors->position_alone = !given;
  if (!given) return;
  if (tilted) map->Fail("tilt", "does not go with velocity and attitude");
  errors->velocity = NeededSigma(map, "velocity", Quantity::kSpeed);
  errors->attitude = NeededSigma(map, "attitude", Quantity::kAngle);
}

const ConfigTable<StartErrors>& StartErrorTable() {
  using Key = ConfigKey<StartErrors>;
  static const ConfigTable<StartErrors> kTable = {
      "scenario: start_errors",
      "Sigmas of the initial values. Without velocity and attitude only the "
      "position is given, for alignment to find the rest.",
      {{.name = "position",
        .value = Key::Special{[](ConfigMap* map, StartErrors* errors) {
          errors->position = NeededSigma(map, "position", Quantity::kLength);
        }},
        .needed = true},
       {.name = "velocity",
        .value = Key::Special{ReadAttitudeErrors},
        .help = "with attitude"},
       {.name = "attitude",
        .value = Key::Special{},
        .help = "roll, pitch, heading; with velocity"},
       {.name = "tilt",
        .value = Key::Special{},
        .help = "instead, with heading: size of the attitude error, drawn in "
                "direction alone; the velocity is the first that is measured"},
       {.name = "heading", .value = Key::Special{}, .help = "likewise"}}};
  return kTable;
}

void ReadStartErrors(ConfigMap* top, Scenario* scenario) {
  if (!top->Has("start_errors")) return;
  ConfigMap map = top->Map("start_errors");
  ReadTable(StartErrorTable(), &map, &scenario->start_errors.emplace());
  map.Finish();
}

void ReadInjections(ConfigMap* top, Scenario* scenario) {
  if (!top->Has("inject")) return;
  for (const std::string& text : top->List("inject")) {
    try {
      scenario->injections.push_back(ParseInjection(text));
    } catch (const std::invalid_argument& error) {
      top->Fail("inject", "'" + text + "': " + error.what());
    }
  }
}

const ConfigTable<Scenario>& ScenarioTable() {
  using Key = ConfigKey<Scenario>;
  static const ConfigTable<Scenario> kTable = {
      "scenario",
      "A file that `simulate` and `montecarlo` take; --set=KEY=VALUE changes a "
      "key of it, as aiding.gnss.sigma=2 m, where * stands for every name and "
      "the value ~ takes a key away.",
      {{.name = "name",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          scenario->name = top->Text(
              "name", std::filesystem::path(top->file()).stem().string());
        }},
        .help = "of the recording",
        .fallback = "file name"},
       {.name = "description",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          scenario->description = top->Text("description", "");
        }},
        .help = "a line"},
       {.name = "start",
        .value = Key::Special{ReadMotion},
        .help = "place and motion at t = 0"},
       {.name = "segments",
        .value = Key::Special{},
        .help = "list of manoeuvres; instead of it one of the next four"},
       {.name = "wander", .value = Key::Special{}, .help = "a drawn route"},
       {.name = "way_points", .value = Key::Special{}, .help = "a spline"},
       {.name = "hand", .value = Key::Special{}, .help = "a sensor in a hand"},
       {.name = "profile",
        .value = Key::Special{},
        .help = "file of a motion, as --profile of `simulate`; without start"},
       {.name = "duration",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          if (!top->Has("duration")) return;
          scenario->duration = top->Positive("duration", Quantity::kTime);
        }},
        .help = "the simulation ends here",
        .fallback = "that of the motion"},
       {.name = "imu",
        .value = Key::Special{ReadImuModel},
        .help = "the inertial sensor",
        .needed = true},
       {.name = "aiding",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          if (!top->Has("aiding")) return;
          ConfigMap aiding = top->Map("aiding");
          for (auto& [name, map] : aiding.NamedMaps()) {
            scenario->aiding.push_back(ReadAidingModel(name, &map));
          }
        }},
        .help = "the other sensors"},
       {.name = "truth_rate",
        .quantity = Quantity::kFrequency,
        .value = Key::Number{&Scenario::truth_rate_hz, KeyRange::kPositive}},
       {.name = "start_errors",
        .value = Key::Special{ReadStartErrors},
        .help = "without it the recording has no initial values"},
       {.name = "stationary",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          scenario->stationary = ReadStationary(top);
        }},
        .help = "as of a recording, and so the next",
        .fallback = "off"},
       {.name = "withhold",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          scenario->withholdings = ReadWithholdings(top);
        }}},
       {.name = "inject",
        .value = Key::Special{ReadInjections},
        .help = "list of errors of measurements, each as of --inject of `run`"},
       {.name = "nodes",
        .value = Key::Special{[](ConfigMap* top, Scenario* scenario) {
          ReadNodes(top, &scenario->max_node_spacing);
        }}},
       {.name = "choices",
        .value = Key::Special{},
        .help = "CHOICE: {NAME: {keys}}: lays keys over those of the file, of "
                "the NAME that --set=CHOICE=NAME or a key CHOICE names, else "
                "of the first"}}};
  return kTable;
}

Scenario ReadScenario(ConfigMap top) {
  Scenario scenario;
  ReadTable(ScenarioTable(), &top, &scenario);
  top.Finish();
  return scenario;
}

ConfigMap::Edit Changing(const ScenarioChanges& changes) {
  return [changes](YAML::Node* top) { EditScenario(changes, top); };
}

std::string NameOf(const ScenarioText& scenario) {
  return std::filesystem::path(scenario.name).stem().string();
}

}  // namespace

std::vector<std::filesystem::path> ScenarioFiles(const std::string& path) {
  ConfigMap top = ConfigMap::Load(path, Changing({}));
  const std::filesystem::path file(path);
  if (!top.Has("profile")) return {file};
  return {file, file.parent_path() / top.Text("profile")};
}

Scenario LoadScenario(const std::string& path, const ScenarioChanges& changes) {
  return ReadScenario(ConfigMap::Load(path, Changing(changes)));
}

std::vector<std::string> ScenarioNames() {
  std::vector<std::string> names;
  for (const ScenarioText& scenario : ScenarioTexts()) {
    names.push_back(NameOf(scenario));
  }
  return names;
}

Scenario FindScenario(const std::string& name_or_path,
                      const ScenarioChanges& changes) {
  std::string known;
  for (const ScenarioText& scenario : ScenarioTexts()) {
    if (NameOf(scenario) == name_or_path) {
      return ReadScenario(ConfigMap::Parse(std::string(scenario.text),
                                           std::string(scenario.name),
                                           Changing(changes)));
    }
    known += (known.empty() ? "" : ", ") + NameOf(scenario);
  }
  if (PathExists(name_or_path)) return LoadScenario(name_or_path, changes);
  throw InputError("'" + name_or_path +
                   "' is no built-in scenario; there are " + known);
}

std::vector<KeySection> ScenarioSections() {
  std::vector<KeySection> sections = {Documented(ScenarioTable())};
  for (KeySection& section : MotionSections()) {
    sections.push_back(std::move(section));
  }
  for (KeySection& section : SimulatedSensorSections()) {
    sections.push_back(std::move(section));
  }
  sections.push_back(Documented(StartErrorTable()));
  return sections;
}

}  // namespace hindsight
