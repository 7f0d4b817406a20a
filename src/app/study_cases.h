#ifndef HINDSIGHT_APP_STUDY_CASES_H_
#define HINDSIGHT_APP_STUDY_CASES_H_

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/config/scenario_config.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// A key of a scenario that differs between cases.
struct Axis {
  std::string key;     ///< of ScenarioChanges
  std::string values;  ///< with "|" between them
  /// Label column that the value stands in, beside those of other axes of the
  /// column; "": none, where there is one value alone.
  std::string column = {};
  std::string before = {};    ///< stands before the value there
  bool without_unit = false;  ///< only the first word of the value stands there
};

/// The cases of a comparison, every value of an axis with every one of the
/// others, the last axis changing fastest.
struct CaseList {
  struct Entry {
    std::vector<std::string> labels;
    ScenarioChanges changes;
  };
  std::vector<std::string> columns;
  std::vector<Entry> cases;
  /// Values of the axes that have no column.
  std::vector<std::pair<std::string, std::string>> settings;
};

/// With --set and --sweep, which give an axis other values or add one. Throws
/// UsageError.
CaseList MakeCases(std::vector<Axis> axes);

/// The changes of --set, each of one value. Throws UsageError.
ScenarioChanges ReadChanges();

/// The files that are read for arguments that name some.
std::vector<std::filesystem::path> FilesOf(
    const std::vector<std::string>& names_or_paths);

/// The scenario's motion is made once, for all seeds.
Recording RecordingOf(const Scenario& scenario);

/// What is tried on the recordings of a scenario.
using TrialOf = std::function<Trial(const Scenario& scenario)>;

/// The scenario under the changes of each entry. Throws InputError.
std::vector<Case> CasesOf(const std::string& scenario, const CaseList& list,
                          const TrialOf& trial_of);
std::vector<Case> CasesOf(const std::string& scenario, const CaseList& list,
                          const Trial& trial);

/// A job of each case.
Jobs JobEach(const std::vector<Case>& cases);

/// The comparison of the listed cases, which has no name yet.
Study StudyOf(const CaseList& list, std::vector<StudyTable> tables, Jobs jobs);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_CASES_H_
