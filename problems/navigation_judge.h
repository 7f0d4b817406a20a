#ifndef HINDSIGHT_PROBLEMS_NAVIGATION_JUDGE_H_
#define HINDSIGHT_PROBLEMS_NAVIGATION_JUDGE_H_

#include <vector>

#include "dataset/dataset.h"
#include "evaluation/run_table.h"
#include "evaluation/state_errors.h"
#include "state/solution.h"

namespace hindsight {

/// A solution against the truth at those of the times [s] that it has as nodes,
/// at all its nodes if there are none, into a record. A judged node without
/// truth is an InputError.
///
/// Values of a cell: seconds, nis_sum and nis_rows (over the residuals used),
/// position_rms and position_max [m], heading_rms and attitude_rms [rad], over
/// time; position_nees and attitude_nees (3 is right), their means over time;
/// outside_5_sigma, share of times at which position or attitude lies beyond
/// 5 sigmas of a component (of attitude alone those of positions are absent);
/// constants_beyond_5_sigma, how many constants do;
/// rule:NAME, 1 for each rule of the grade (evaluation/grade.h) that lowers it;
/// end_horizontal [m]; states, dimension of the error.
/// Series: position_n, _e, _d, truth less estimate [m]; yaw [rad]; nees,
/// e'P^-1e of the whole error state.
StateErrors JudgeSolution(const Dataset& dataset,
                          const std::vector<double>& times,
                          const Solution& solution, RunRecord* record);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NAVIGATION_JUDGE_H_
