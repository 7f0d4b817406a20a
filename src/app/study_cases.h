#ifndef HINDSIGHT_APP_STUDY_CASES_H_
#define HINDSIGHT_APP_STUDY_CASES_H_

#include <filesystem>
#include <functional>
#include <string>
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

/// What is tried on the recordings of a scenario, and what was changed in it.
using TrialOf = std::function<Trial(const Scenario& scenario,
                                    const ScenarioChanges& changes)>;
TrialOf OnAll(const Trial& trial);

/// Trials on a scenario, every value of an axis with every one of the others,
/// the last axis changing fastest.
struct ScenarioTrials {
  std::string scenario;  ///< name or path
  std::vector<Axis> axes;
  TrialOf trial_of;
  std::vector<StudyTable> tables;  ///< label columns of the cases go before
};

/// That comparison, which has no name yet, with --set and --sweep, which give an
/// axis other values or add one. Throws UsageError, InputError.
Study StudyOf(const ScenarioTrials& trials);

/// The changes of --set, each of one value. Throws UsageError.
ScenarioChanges ReadChanges();

/// The files that are read for arguments that name some.
std::vector<std::filesystem::path> FilesOf(
    const std::vector<std::string>& names_or_paths);

/// The scenario's motion is made once, for all seeds.
Recording RecordingOf(const Scenario& scenario);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_CASES_H_
