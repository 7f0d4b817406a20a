#include "app/study_cases.h"

#include <algorithm>
#include <memory>
#include <set>

#include "app/flags.h"
#include "base/error.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// KEY and VALUES of every --set.
std::vector<Axis> AskedAxes() {
  std::vector<Axis> axes;
  for (const std::string& text : Split(FLAGS_set, ';')) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == text.npos) {
      throw UsageError("--set=" + text + ": expected KEY=VALUE");
    }
    axes.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return axes;
}

/// "0.05 deg/h|0.1 deg/h" of "0.05, 0.1 deg/h".
std::string SweptValues(const std::string& flag, const std::string& text) {
  std::vector<std::string> values = Split(text, ',');
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

/// KEY and values of every --sweep.
std::vector<Axis> SweptAxes() {
  std::vector<Axis> axes;
  for (const std::string& text : Split(FLAGS_sweep, ';')) {
    const std::string flag = "--sweep=" + text;
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == text.npos) {
      throw UsageError(flag + ": expected KEY=V1,V2,... UNIT");
    }
    axes.push_back(
        {text.substr(0, equals), SweptValues(flag, text.substr(equals + 1))});
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

Recording RecordingOf(const Scenario& scenario) {
  const auto perfect = std::make_shared<const PerfectRecording>(scenario);
  return [perfect](std::uint64_t seed) { return perfect->Realize(seed); };
}

std::vector<Case> CasesOf(const std::string& scenario, const CaseList& list,
                          const Trial& trial) {
  std::vector<Case> cases;
  for (const CaseList::Entry& entry : list.cases) {
    const Scenario changed = FindScenario(scenario, entry.changes);
    cases.push_back(
        {entry.labels, [changed] { return RecordingOf(changed); }, trial});
  }
  return cases;
}

}  // namespace hindsight
