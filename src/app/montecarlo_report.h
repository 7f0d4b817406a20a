#ifndef HINDSIGHT_APP_MONTECARLO_REPORT_H_
#define HINDSIGHT_APP_MONTECARLO_REPORT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// Name of the file with the figures of a Monte Carlo comparison.
inline constexpr char kMonteCarloJson[] = "montecarlo.json";

/// What was run, as the report names it.
struct MonteCarloTitle {
  std::string scenario;
  std::string path;
  std::string noise;
  int runs_asked = 0;
  std::uint64_t first_seed = 1;
  bool complete = true;
};

/// Heading and cell of the counts of runs that are usable, doubtful, not
/// usable.
inline constexpr const char* kGradesTitle = "usable,\ndoubtful,\nnot";
std::string GradesCell(const MethodStatistics& method);

/// One line a method: largest standard deviations, ANEES, NIS, grades, seconds.
std::string MonteCarloTable(const MonteCarloResult& result);

/// The pairs of methods whose agreement is of interest, a line each.
std::string AgreementText(const MonteCarloResult& result);

/// montecarlo.json:
///   {"scenario", "path", "noise", "complete", "runs", "runs_asked",
///    "first_seed", "states",
///    "methods": {NAME: {"max_std_m": [N, E, D],
///        "legs": [{"max_std_m": [N, E, D], "anees"}], "final_std_m": [N, E,
///        D], "yaw_std_deg", "anees", "anees_outside", "nis", "failed",
///        "grades": {"usable", "doubtful", "not usable"}, "seconds_per_run",
///        "constants": {NAME: {"unit", "prior_sigma", "sigma", "rms", "anees",
///            "runs", "observed", "unobserved"}}}},
///    "agreement": {"A_vs_B_m", "A_vs_B_rad", "A_vs_B_after_first_leg_m"}}
/// Figures are of the first `runs`; complete is false if fewer than asked were
/// finished or not all files are there. Standard deviations are over the runs
/// and their maxima over time; anees is the mean over time and should equal
/// `states`; anees_outside is the share of epochs outside the two-sided 95 %
/// bounds; nis is a row's mean and should be 1; constants are those whose true
/// value the data know, anees the mean square of error over sigma; seconds are
/// processor time of the method alone (smoothers without the forward filter,
/// iterated and batch from the smoother on). A figure that does not exist is
/// absent.
std::string MonteCarloJson(const MonteCarloTitle& title,
                           const MonteCarloResult& result);

/// Time series of one method: t[s], std_n[m], std_e[m], std_d[m], std_yaw[deg],
/// anees[1].
std::string MonteCarloCsv(const MethodStatistics& method);

/// All files: montecarlo.json first and METHOD.csv of every method.
std::vector<OutputFile> MonteCarloFiles(const MonteCarloTitle& title,
                                        const MonteCarloResult& result);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_MONTECARLO_REPORT_H_
