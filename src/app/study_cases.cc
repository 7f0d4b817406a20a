#include "app/study_cases.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "app/flags.h"
#include "io/read/paths.h"
#include "io/read/units.h"

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

/// A case to be, of changes of a scenario.
struct Entry {
  std::vector<std::string> labels;
  ScenarioChanges changes;
};

/// Every value of the axis with every entry.
std::vector<Entry> Crossed(const std::vector<Entry>& entries, const Axis& axis,
                           const std::vector<std::string>& values) {
  std::vector<Entry> crossed;
  for (const Entry& entry : entries) {
    for (const std::string& value : values) {
      Entry& one = crossed.emplace_back(entry);
      one.changes.push_back(axis.key + "=" + value);
      if (values.size() > 1) one.labels.push_back(value);
    }
  }
  return crossed;
}

/// The scenario's motion is made once, for all seeds.
Recording RecordingOf(const Scenario& scenario) {
  const auto perfect = std::make_shared<const PerfectRecording>(scenario);
  return [perfect](std::uint64_t seed) { return perfect->Realize(seed); };
}

}  // namespace

Study StudyOf(const ScenarioTrials& trials) {
  Study study;
  std::vector<std::string> columns, names;
  if (trials.by_name) columns.emplace_back("scenario");
  std::vector<Entry> entries(1);
  for (const Axis& axis : WithFlags(trials.axes)) {
    const std::vector<std::string> values = ValuesOf(axis);
    entries = Crossed(entries, axis, values);
    if (values.size() > 1) {
      columns.push_back(axis.key);
    } else {
      study.settings.emplace_back(axis.key, values[0]);
    }
  }
  for (const StudyTable& table : trials.tables) {
    study.tables.push_back(Under(columns, table));
  }
  for (const std::string& name_or_path : trials.scenarios) {
    for (const Entry& entry : entries) {
      const Scenario changed = FindScenario(name_or_path, entry.changes);
      std::vector<std::string> labels = entry.labels;
      if (trials.by_name) labels.insert(labels.begin(), changed.name);
      if (&entry == &entries.front()) names.push_back(changed.name);
      study.cases.push_back(
          {labels, [changed] { return RecordingOf(changed); }, trials.trial});
    }
    if (std::ranges::count(names, names.back()) > 1) {
      throw UsageError("two scenarios of the name '" + names.back() + "'");
    }
  }
  if (trials.by_name) study.name = Joined(names, ",");
  return study;
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

}  // namespace hindsight
