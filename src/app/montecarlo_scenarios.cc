#include "app/montecarlo_scenarios.h"

#include <algorithm>

#include "app/flags.h"
#include "simulation/calibration_drive.h"
#include "simulation/gps_jumps.h"
#include "simulation/in_flight_alignment.h"
#include "simulation/tunnel_survey.h"
#include "simulation/uuv_scenarios.h"
#include "simulation/vibration_attitude.h"

namespace hindsight {
namespace {

/// Flags that every scenario takes.
const std::vector<std::string> kFlagsOfAll = {
    "out", "force", "clean", "runs", "seed", "threads", "progress"};

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "gps_jumps", "tunnel_survey, uuv_survey".
std::string ScenariosWith(const std::string& flag) {
  std::string names;
  for (const MonteCarloScenario& scenario : MonteCarloScenarios()) {
    if (!Has(scenario.flags, flag)) continue;
    names += (names.empty() ? "" : ", ") + scenario.name;
  }
  return names;
}

}  // namespace

const std::vector<MonteCarloScenario>& MonteCarloScenarios() {
  static const std::vector<MonteCarloScenario> scenarios = {
      {kTunnelSurveyName, RunTunnelSurvey, {"path", "white_noise", "sweep"}},
      {kInFlightAlignmentName,
       RunInFlightAlignment,
       {"rates", "tilt", "heading", "rules", "error", "gamma", "alpha",
        "alpha_blocks", "delta", "bounded", "back_off"},
       300},
      {kVelocityAlignmentName, RunVelocityAlignment, {"rates"}},
      {kCalibrationName, RunCalibration, {}},
      {kGpsJumpsName, RunGpsJumps, {"errors", "gps_sigma", "gps_rate"}},
      {kVibrationAttitudeName, RunVibrationAttitude, {}},
      {kUuvSurveyName, RunUuvSurvey, {"path"}},
      {kUuvCalibrationName, RunUuvCalibration, {}},
      {kUuvSearchName, RunUuvSearch, {"reading"}}};
  return scenarios;
}

const MonteCarloScenario& FindMonteCarloScenario(const std::string& name) {
  std::string known;
  std::vector<std::string> names;
  for (const MonteCarloScenario& scenario : MonteCarloScenarios()) {
    if (scenario.name == name) return scenario;
    known += (known.empty() ? "" : ", ") + scenario.name;
    names.push_back(scenario.name);
  }
  throw UsageError("'montecarlo' knows no scenario '" + name + "'" +
                   Suggestion(name, names) + "; there is " + known);
}

void CheckScenarioFlags(const MonteCarloScenario& scenario,
                        const std::vector<FlagUse>& flags) {
  for (const FlagUse& flag : flags) {
    if (!IsGiven(flag.name) || Has(kFlagsOfAll, flag.name) ||
        Has(scenario.flags, flag.name)) {
      continue;
    }
    throw UsageError("--" + Dashed(flag.name) + " means nothing to " +
                     scenario.name + "; it goes with " +
                     ScenariosWith(flag.name));
  }
}

std::vector<FlagUse> WithScenarioNames(std::vector<FlagUse> flags) {
  for (FlagUse& flag : flags) {
    const std::string names = ScenariosWith(flag.name);
    if (!names.empty()) flag.help += "; of " + names;
  }
  return flags;
}

}  // namespace hindsight
