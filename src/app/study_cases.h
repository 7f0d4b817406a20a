#ifndef HINDSIGHT_APP_STUDY_CASES_H_
#define HINDSIGHT_APP_STUDY_CASES_H_

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/config/scenario_config.h"
#include "problems/navigation_trial.h"

namespace hindsight {

/// A key of a scenario, of ScenarioChanges, and its values with "|" between
/// them: a label column of the cases where there are several, else a setting.
struct Axis {
  std::string key;
  std::string values;
};

/// Trials on scenarios, every value of an axis with every one of the others, the
/// last axis changing fastest.
struct ScenarioTrials {
  std::vector<std::string> scenarios;  ///< names or paths
  std::vector<Axis> axes;
  std::function<Trial(const Scenario&)> trial_of;
  std::vector<StudyTable> tables;  ///< label columns of the cases go before
  bool by_name = false;            ///< the scenario is a column as well
};

/// NavigationTrialOf, which knows when the scenario's sensors are silent.
std::function<Trial(const Scenario&)> Navigate(const NavigationTrial& trial);
std::function<Trial(const Scenario&)> OnAll(const Trial& trial);

/// That comparison with --set and --sweep, which give an axis other values or
/// add one; of columns by name it has the name of all, else none. Throws
/// UsageError, and for two scenarios of one name; InputError.
Study StudyOf(const ScenarioTrials& trials);

/// The changes of --set, each of one value. Throws UsageError.
ScenarioChanges ReadChanges();

/// The files that are read for arguments that name some.
std::vector<std::filesystem::path> FilesOf(
    const std::vector<std::string>& names_or_paths);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_CASES_H_
