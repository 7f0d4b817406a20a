#ifndef HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_

#include <string>
#include <vector>

#include "problems/montecarlo.h"
#include "problems/papers/lyapunov.h"

namespace hindsight {

/// A forward filter to compare.
struct ObserverModel {
  std::string rule;  ///< as printed, with its parameters
  ForwardModel model;
};

/// One filter of velocity, attitude and both biases, the position being known, on
/// a recording that gives velocity, attitude and their sigmas: diverged, escaped,
/// converged (0 or 1; problems/papers/attitude_limits.h); t_settled [s], the
/// first time from which tilt, the angle between true and estimated vertical,
/// and heading, the difference of the Euler angles, stay inside kSettledAttitude,
/// infinite if they do not at the end; tilt and heading at the end [rad]; then
/// t_escape [s], or backed_off, the share of the steps, and least_information
/// (BoundRecord) and those of AnalyseRun.
RunValues RunObserver(const ForwardModel& model, const Dataset& dataset,
                      Timeline timeline);

/// Every filter on a recording, whose nodes and preintegration are made once. A
/// node without truth is an InputError.
///
/// Figures by rule and error: shares
/// diverged (escaped ones included), escaped and converged (settled at the
/// end); t_escape, median of those; of t_settled, tilt and heading at the end
/// the percentiles _50 and _95 over all runs, escaped ones counting as
/// infinite; of the runs that did not escape the mean share of backed_off
/// steps, the median of least_information, medians of what AnalyseRun gives, and
/// extremes of the eigenvalues of P.
Trial ObserverTrial(const std::vector<ObserverModel>& models);
StudyTable ObserverTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_
