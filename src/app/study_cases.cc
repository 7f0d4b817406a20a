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

void Add(const Axis& axis, const std::string& value, CaseList::Entry* entry,
         std::size_t column) {
  entry->changes.push_back(axis.key + "=" + value);
  if (axis.column.empty()) return;
  entry->labels.resize(std::max(entry->labels.size(), column + 1));
  entry->labels[column] +=
      axis.before +
      (axis.without_unit ? value.substr(0, value.find(' ')) : value);
}

}  // namespace

CaseList MakeCases(std::vector<Axis> axes) {
  std::vector<Axis> given = AskedAxes();
  for (Axis& axis : SweptAxes()) given.push_back(std::move(axis));
  for (const Axis& asked : given) {
    const auto same = [&](const Axis& axis) { return axis.key == asked.key; };
    const auto found = std::find_if(axes.begin(), axes.end(), same);
    if (found == axes.end()) {
      axes.push_back(asked);
    } else {
      found->values = asked.values;
    }
  }
  CaseList list;
  list.cases.emplace_back();
  for (Axis& axis : axes) {
    const std::vector<std::string> values = ValuesOf(axis);
    if (axis.column.empty() && values.size() > 1) axis.column = axis.key;
    auto at = std::find(list.columns.begin(), list.columns.end(), axis.column);
    const auto column = static_cast<std::size_t>(at - list.columns.begin());
    if (axis.column.empty()) {
      list.settings.emplace_back(axis.key, values[0]);
    } else if (at == list.columns.end()) {
      list.columns.push_back(axis.column);
    }
    std::vector<CaseList::Entry> more;
    for (const CaseList::Entry& entry : list.cases) {
      for (const std::string& value : values) {
        Add(axis, value, &more.emplace_back(entry), column);
      }
    }
    list.cases = std::move(more);
  }
  return list;
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

std::vector<Case> CasesOf(const std::string& scenario, const CaseList& list,
                          const TrialOf& trial_of) {
  std::vector<Case> cases;
  for (const CaseList::Entry& entry : list.cases) {
    const Scenario changed = FindScenario(scenario, entry.changes);
    cases.push_back({entry.labels, [changed] { return RecordingOf(changed); },
                     trial_of(changed)});
  }
  return cases;
}

std::vector<Case> CasesOf(const std::string& scenario, const CaseList& list,
                          const Trial& trial) {
  return CasesOf(scenario, list, [&](const Scenario&) { return trial; });
}

Jobs JobEach(const std::vector<Case>& cases) {
  Jobs jobs;
  for (const Case& one : cases) jobs.push_back(JobOf({one}));
  return jobs;
}

Study StudyOf(const CaseList& list, std::vector<StudyTable> tables, Jobs jobs) {
  return {"", list.settings, std::move(tables), std::move(jobs)};
}

}  // namespace hindsight
