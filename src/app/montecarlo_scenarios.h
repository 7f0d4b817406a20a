#ifndef HINDSIGHT_APP_MONTECARLO_SCENARIOS_H_
#define HINDSIGHT_APP_MONTECARLO_SCENARIOS_H_

#include <functional>
#include <string>

#include "app/progress.h"
#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// Name of the file with the figures of a Monte Carlo comparison.
inline constexpr char kMonteCarloJson[] = "montecarlo.json";

/// The name of RunUuvSearch.
inline constexpr char kUuvSearchName[] = "uuv_search";

/// One scenario that `hindsight montecarlo` can repeat. `run` reads the flags
/// of its own, writes its files into the folder and prints its table; it throws
/// UsageError for flags that do not fit, before it computes anything.
struct MonteCarloScenario {
  std::string name;
  void (*run)(MonteCarloOptions options, Progress* progress,
              ResultFolder* folder) = nullptr;
};

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
