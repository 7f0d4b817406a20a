#include "app/study_cases.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "app/flags.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// "0.05 deg/h|0.1 deg/h" of "0.05, 0.1 deg/h".
std::string SweptValues(const Axis& axis) {
  const std::string flag = "--sweep=" + axis.key + "=" + axis.values;
  std::vector<std::string> values = Split(axis.values, ',');
  if (values.size() < 2) throw UsageError(flag + ": expected V1,V2,... UNIT");
  const auto unit_of = [](const std::string& value) {
    const std::size_t blank = value.find(' ');
    return blank == value.npos ? "" : value.substr(blank);
  };
  std::string joined;
  for (std::string& value : values) {
    const std::string unit = unit_of(value);
    if (!ParseNumber(value.substr(0, value.size() - unit.size()))) {
      throw UsageError(flag + ": '" + value + "' is no number with its unit");
    }
    if (unit.empty()) value += unit_of(values.back());
    joined += (joined.empty() ? "" : "|") + value;
  }
  return joined;
}

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

std::vector<Axis> SweptAxes() {
  std::vector<Axis> axes =
      KeysAndValues("--sweep=", FLAGS_sweep, "V1,V2,... UNIT");
  for (Axis& axis : axes) axis.values = SweptValues(axis);
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

/// What is different of a case, and its labels.
struct Entry {
  std::vector<std::string> labels;
  ScenarioChanges changes;
};

void Add(const Axis& axis, const std::string& value, std::size_t column,
         Entry* entry) {
  entry->changes.push_back(axis.key + "=" + value);
  if (axis.column.empty()) return;
  entry->labels.resize(std::max(entry->labels.size(), column + 1));
  entry->labels[column] +=
      axis.before +
      (axis.without_unit ? value.substr(0, value.find(' ')) : value);
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

}  // namespace

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

TrialOf OnAll(const Trial& trial) {
  return [trial](const Scenario&, const ScenarioChanges&) { return trial; };
}

Study StudyOf(const ScenarioTrials& trials) {
  Study study;
  std::vector<std::string> columns;
  std::vector<Entry> entries(1);
  for (Axis& axis : WithFlags(trials.axes)) {
    const std::vector<std::string> values = ValuesOf(axis);
    if (axis.column.empty() && values.size() > 1) axis.column = axis.key;
    const auto at = std::ranges::find(columns, axis.column);
    const auto column = static_cast<std::size_t>(at - columns.begin());
    if (axis.column.empty()) {
      study.settings.emplace_back(axis.key, values[0]);
    } else if (at == columns.end()) {
      columns.push_back(axis.column);
    }
    std::vector<Entry> more;
    for (const Entry& entry : entries) {
      for (const std::string& value : values) {
        Add(axis, value, column, &more.emplace_back(entry));
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

}  // namespace hindsight
