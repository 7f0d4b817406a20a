#ifndef HINDSIGHT_APP_STUDY_CASES_H_
#define HINDSIGHT_APP_STUDY_CASES_H_

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/config/scenario_config.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// A key of a scenario, of ScenarioChanges, and its values with "|" between
/// them: a label column of the cases where there are several, else a setting.
struct Axis {
  std::string key;
  std::string values;
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

/// Any scenarios that `simulate` takes, by the methods of --methods; a case
/// each. Two of one name are one case.
Study ScenarioStudy(const std::vector<std::string>& names_or_paths);

/// The changes of --set, each of one value. Throws UsageError.
ScenarioChanges ReadChanges();

/// The files that are read for arguments that name some.
std::vector<std::filesystem::path> FilesOf(
    const std::vector<std::string>& names_or_paths);

/// The scenario's motion is made once, for all seeds.
Recording RecordingOf(const Scenario& scenario);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_CASES_H_
