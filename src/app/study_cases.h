#ifndef HINDSIGHT_APP_STUDY_CASES_H_
#define HINDSIGHT_APP_STUDY_CASES_H_

#include <filesystem>
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

/// Trials on scenarios, every value of an axis with every one of the others, the
/// last axis changing fastest.
struct ScenarioTrials {
  std::vector<std::string> scenarios;  ///< names or paths
  std::vector<Axis> axes;
  Trial trial;
  std::vector<StudyTable> tables;  ///< label columns of the cases go before
  bool by_name = false;            ///< the scenario is a column as well
};

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
