#include "app/study_cases.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "app/asked_methods.h"
#include "app/flags.h"
#include "io/read/paths.h"
#include "io/read/units.h"
#include "problems/navigation_trial.h"

namespace hindsight {
namespace {

/// KEY and what follows its "=" of every part of a flag.
std::vector<Axis> KeysAndValues(const std::string& flag,
                                const std::string& text,
                                const std::string& expected) {
  std::vector<Axis> axes;
  for (const std::string& part : Split(text, ';')) {
    const std::size_t equals = part.find('=');
    if (equals == 0 || equals == part.npos) {
      throw UsageError(flag + part + ": expected KEY=" + expected);
    }
    axes.push_back({part.substr(0, equals), part.substr(equals + 1)});
  }
  return axes;
}

std::vector<Axis> AskedAxes() {
  return KeysAndValues("--set=", FLAGS_set, "VALUE");
}

/// "0.05 deg/h|0.1 deg/h" of "0.05, 0.1 deg/h".
std::vector<Axis> SweptAxes() {
  std::vector<Axis> axes =
      KeysAndValues("--sweep=", FLAGS_sweep, "V1,V2,... UNIT");
  for (Axis& axis : axes) {
    const std::string flag = "--sweep=" + axis.key + "=" + axis.values;
    std::vector<std::string> values = Split(axis.values, ',');
    if (values.size() < 2) throw UsageError(flag + ": expected V1,V2,... UNIT");
    const std::string unit = values.back().substr(
        std::min(values.back().find(' '), values.back().size()));
    for (std::string& value : values) {
      if (!ParseNumber(value.substr(0, value.find(' ')))) {
        throw UsageError(flag + ": '" + value + "' is no number with its unit");
      }
      if (value.find(' ') == value.npos) value += unit;
    }
    axis.values = Joined(values, "|");
  }
  return axes;
}

std::vector<std::string> ValuesOf(const Axis& axis) {
  const std::vector<std::string> values = Split(axis.values, '|');
  const std::set<std::string> distinct(values.begin(), values.end());
  const std::string flag = "--set=" + axis.key + "=" + axis.values;
  if (values.empty() || distinct.contains("")) {
    throw UsageError(flag + ": a value is missing");
  }
  if (distinct.size() < values.size()) {
    throw UsageError(flag + ": a value stands there twice");
  }
  return values;
}

/// The axes as the flags have them.
std::vector<Axis> WithFlags(std::vector<Axis> axes) {
  for (const std::vector<Axis>& given : {AskedAxes(), SweptAxes()}) {
    for (const Axis& asked : given) {
      const auto found = std::ranges::find(axes, asked.key, &Axis::key);
      if (found == axes.end()) {
        axes.push_back(asked);
      } else {
        found->values = asked.values;
      }
    }
  }
  return axes;
}

/// That knows when the scenario's sensors are silent.
Trial ScenarioTrial(const std::vector<std::string>& methods,
                    const Scenario& scenario) {
  NavigationTrial trial = {.methods = methods, .judged_every = 1.0};
  for (const AidingModel& model : scenario.aiding) {
    for (const TimeSpan& outage : model.outages) {
      trial.silent_spans.push_back(
          {model.sensor.name, outage.begin, outage.end});
    }
  }
  return NavigationTrialOf(trial);
}

}  // namespace

TrialOf OnAll(const Trial& trial) {
  return [trial](const Scenario&, const ScenarioChanges&) { return trial; };
}

Study StudyOf(const ScenarioTrials& trials) {
  struct Entry {
    std::vector<std::string> labels;
    ScenarioChanges changes;
  };
  Study study;
  std::vector<std::string> columns;
  std::vector<Entry> entries(1);
  for (const Axis& axis : WithFlags(trials.axes)) {
    const std::vector<std::string> values = ValuesOf(axis);
    const bool is_column = values.size() > 1;
    if (is_column) {
      columns.push_back(axis.key);
    } else {
      study.settings.emplace_back(axis.key, values[0]);
    }
    std::vector<Entry> more;
    for (const Entry& entry : entries) {
      for (const std::string& value : values) {
        Entry& one = more.emplace_back(entry);
        one.changes.push_back(axis.key + "=" + value);
        if (is_column) one.labels.push_back(value);
      }
    }
    entries = std::move(more);
  }
  for (const StudyTable& table : trials.tables) {
    study.tables.push_back(Under(columns, table));
  }
  for (const Entry& entry : entries) {
    const Scenario changed = FindScenario(trials.scenario, entry.changes);
    study.cases.push_back({entry.labels,
                           [changed] { return RecordingOf(changed); },
                           trials.trial_of(changed, entry.changes)});
  }
  return study;
}

Study ScenarioStudy(const std::vector<std::string>& names_or_paths) {
  const std::vector<std::string> methods = ReadTrajectoryMethods(FLAGS_methods);
  Study all;
  std::vector<std::string> names;
  for (const std::string& file : names_or_paths) {
    std::string& name = names.emplace_back();
    const auto trial_of = [&](const Scenario& scenario,
                              const ScenarioChanges&) {
      name = scenario.name;
      return ScenarioTrial(methods, scenario);
    };
    Study one = StudyOf({file, {}, trial_of, NavigationTables()});
    if (std::ranges::count(names, name) > 1) {
      throw UsageError("two scenarios of the name '" + name + "'");
    }
    for (Case& added : one.cases) {
      added.labels.insert(added.labels.begin(), name);
      all.cases.push_back(std::move(added));
    }
    all.settings = one.settings;
    all.tables = one.tables;
  }
  for (StudyTable& table : all.tables) table = Under({"scenario"}, table);
  all.name = Joined(names, ",");
  return all;
}

ScenarioChanges ReadChanges() {
  ScenarioChanges changes;
  for (const Axis& axis : AskedAxes()) {
    if (ValuesOf(axis).size() > 1) {
      throw UsageError("--set=" + axis.key + "=" + axis.values +
                       ": expected one value");
    }
    changes.push_back(axis.key + "=" + axis.values);
  }
  return changes;
}

std::vector<std::filesystem::path> FilesOf(
    const std::vector<std::string>& names_or_paths) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names_or_paths) {
    if (!IsFile(name)) continue;
    std::ranges::move(ScenarioFiles(name), std::back_inserter(files));
  }
  return files;
}

Recording RecordingOf(const Scenario& scenario) {
  const auto perfect = std::make_shared<const PerfectRecording>(scenario);
  return [perfect](std::uint64_t seed) { return perfect->Realize(seed); };
}

}  // namespace hindsight
