#ifndef HINDSIGHT_APP_IN_FLIGHT_REPORT_H_
#define HINDSIGHT_APP_IN_FLIGHT_REPORT_H_

#include <string>
#include <vector>

#include "problems/observer_comparison.h"

namespace hindsight {

/// Rule x error definition x start as text for a terminal: a row a cell with
/// shares diverged and converged, times to settle, final errors, and a second
/// table with the Lyapunov figures.
std::string ObserverTable(const std::vector<ObserverCell>& cells);

/// montecarlo.json:
///   {"scenario", "complete", "runs", "runs_asked", "first_seed", "cells":
///   [{"velocity", "start", "rule",
///    "error", "diverged", "escaped", "t_escape_s", "converged",
///    "t_settled_50_s", "t_settled_95_s", "tilt_50_deg", "tilt_95_deg",
///    "heading_50_deg", "heading_95_deg", "lyapunov": {"v_first", "v_last",
///    "v_largest", "share_falling", "share_falling_early", "p_least",
///    "p_largest", "radius_first_deg", "radius_largest_deg"}}]}
/// Shares are of the runs, _50 and _95 percentiles over the runs; a figure that
/// is infinite (never settled) or does not exist is absent. See
/// problems/lyapunov.h for the last group.
std::string ObserverJson(const std::vector<ObserverCell>& cells,
                         const MonteCarloOptions& options, bool complete);

/// The same, a row a cell.
std::string ObserverCsv(const std::vector<ObserverCell>& cells);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_IN_FLIGHT_REPORT_H_
