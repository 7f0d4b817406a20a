#ifndef HINDSIGHT_APP_MONTECARLO_SCENARIOS_H_
#define HINDSIGHT_APP_MONTECARLO_SCENARIOS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/montecarlo_report.h"
#include "app/progress.h"
#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// The names of RunUuvSearch and RunVelocityAlignment.
inline constexpr char kUuvSearchName[] = "uuv_search";
inline constexpr char kVelocityAlignmentName[] = "velocity_alignment";

/// One scenario that `hindsight montecarlo` can repeat. `run` reads the flags
/// of its own, prints its table and commits its files, montecarlo.json among
/// them; an early end leaves the runs, or the settings, that are finished. It
/// throws UsageError for flags that do not fit, before it computes anything.
struct MonteCarloScenario {
  std::string name;
  void (*run)(MonteCarloOptions options, Progress* progress,
              ResultFolder* folder) = nullptr;
  /// What it takes besides --out, --force, --clean, --runs, --seed, --threads
  /// and
  /// --progress, with underscores for dashes.
  std::vector<std::string> flags;
  std::uint64_t default_runs = 100;
};

/// All scenarios. Throws UsageError for a name that is none.
const std::vector<MonteCarloScenario>& MonteCarloScenarios();
const MonteCarloScenario& FindMonteCarloScenario(const std::string& name);

/// Throws UsageError naming the first of `flags` that is given although it
/// means nothing to the scenario, and what it goes with.
void CheckScenarioFlags(const MonteCarloScenario& scenario,
                        const std::vector<FlagUse>& flags);

/// The flags with the scenarios that take them at the end of their help.
std::vector<FlagUse> WithScenarioNames(std::vector<FlagUse> flags);

void RunTunnelSurvey(MonteCarloOptions options, Progress* progress,
                     ResultFolder* folder);

void RunInFlightAlignment(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder);
/// The same flight from no start value at all, at 10 Hz and 1 Hz of velocity,
/// the IMU mounted at any attitude.
void RunVelocityAlignment(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder);
void RunCalibration(MonteCarloOptions options, Progress* progress,
                    ResultFolder* folder);
void RunGpsJumps(MonteCarloOptions options, Progress* progress,
                 ResultFolder* folder);

void RunVibrationAttitude(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder);
/// The fusions of Lee and Yoon (2011) as printed, under --reading.
void RunUuvSearch(MonteCarloOptions options, Progress* progress,
                  ResultFolder* folder);
/// INS, DVL and depth on the paths of UuvPathNames.
void RunUuvSurvey(MonteCarloOptions options, Progress* progress,
                  ResultFolder* folder);
/// Calibration of a DVL in figures of eight, every constant judged.
void RunUuvCalibration(MonteCarloOptions options, Progress* progress,
                       ResultFolder* folder);

/// Reports the number of finished runs out of `runs`.
std::function<void(int)> RunProgress(int runs, Progress* progress);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_MONTECARLO_SCENARIOS_H_
