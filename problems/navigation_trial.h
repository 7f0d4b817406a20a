#ifndef HINDSIGHT_PROBLEMS_NAVIGATION_TRIAL_H_
#define HINDSIGHT_PROBLEMS_NAVIGATION_TRIAL_H_

#include <limits>
#include <string>
#include <vector>

#include "evaluation/innovation_test.h"
#include "problems/montecarlo.h"
#include "state/solution.h"

namespace hindsight {

/// The tables of a study of NavigationTrial. Series: position_n, _e, _d, truth less estimate
/// [m]; yaw [rad]; nees, e'P^-1e of the whole error state.
///   max_std_n, _e, _d    standard deviation over the runs, largest over time
///   legI_max_std_*       the same of leg I; legI_anees
///   end_std_*, yaw_std   at the last time; largest over time
///   anees                mean over time and runs; right is `states`
///   anees_outside        share of times outside of the two-sided 95 % bounds
///   nis                  a row's mean; right is 1
///   position_rms, heading_rms, attitude_rms, position_max   over time and runs
///   position_nees, attitude_nees   means; right is 3
///   outside_5_sigma      share of times at which position or attitude lies
///                        beyond 5 sigmas of a component
///   end_horizontal       of the last position
/// and percentiles, grades, failures, seconds.
std::vector<StudyTable> NavigationTables(
    const std::vector<double>& leg_ends = {});

/// How methods of Reconstruction are tried on a recording of one seed, and what
/// its records hold. Tables of the study:
///   0 cells      the method against truth
///   1 constants  each estimated constant whose true value the data know
///   2 agreement  the largest distance of two methods over all nodes and runs
///   3 outages    each span in which streams were withheld, or silent between
///                begin and end of the truth, with the largest horizontal and
///                vertical error of the states judged within it
struct NavigationTrial {
  std::vector<std::string> methods;
  /// What a cell measures; the study's first table, but for labels before.
  StudyTable cells = NavigationTables().front();
  /// Nodes are also placed at stamps of the truth so far apart or more, and the
  /// states judged at them alone, without the ends, which clocks may move; zero:
  /// at every node, each of which then needs truth [s].
  double judged_every = 0.0;
  double judged_to = std::numeric_limits<double>::infinity();  ///< [s]
  /// Gets Reconstruction::Innovations, none where nothing held; nullptr: not
  /// asked for.
  std::vector<NormalisedInnovation>* innovations = nullptr;
  /// Adds the cell kBestOfRun: what `run` with these methods ends with.
  bool best_of_run = false;
  /// Ends of the legs into which the interval is divided [s], ascending.
  std::vector<double> leg_ends = {};
};

/// In place of a method: the best of those that were run (Best).
inline constexpr char kBestOfRun[] = "run";

inline constexpr std::size_t kCells = 0;
inline constexpr std::size_t kConstants = 1;
inline constexpr std::size_t kAgreement = 2;
inline constexpr std::size_t kOutages = 3;

/// Every method on a recording: all of trajectories or all of attitude alone. A
/// judged node without truth is an InputError.
///
/// A cell holds grade, seconds, and what the table measures; beside it nis_sum
/// and nis_rows (over the residuals used); states, dimension of the error;
/// constants_beyond_5_sigma; rule:NAME, 1 for each rule of the grade
/// (evaluation/grade.h) that lowers it; end_drift, the share of the true path's
/// length that end_horizontal is. Of attitude alone the values and series of
/// positions are absent.
Trial NavigationTrialOf(const NavigationTrial& trial);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NAVIGATION_TRIAL_H_
