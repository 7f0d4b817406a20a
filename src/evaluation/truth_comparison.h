#ifndef HINDSIGHT_EVALUATION_TRUTH_COMPARISON_H_
#define HINDSIGHT_EVALUATION_TRUTH_COMPARISON_H_

#include <vector>

#include "dataset/dataset.h"
#include "evaluation/solution_table.h"
#include "evaluation/trajectory_error.h"

namespace hindsight {

/// The reference of one solution: points and the place they speak of.
struct SolutionTruth {
  TruthSeries points;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU [m]
};

/// The data set's truth; where that is a sensor's positions
/// (Dataset::truth_stream), with the clock and at the lever arm that the
/// solution's last node has for that sensor, as far as it estimates them.
SolutionTruth TruthOf(const Dataset& dataset, const Solution& solution);

/// Leaves out truth points closer than 0.1 s to the one before, and of more
/// than 50 000 so many that they are evenly fewer: a trajectory says nothing
/// new in between, and samples with covariances are large.
void ThinTruth(TruthSeries* truth);

/// Whether `solution` has a row at every one of the truth's times between its
/// first and its last.
bool HasRowsAtTruth(const SolutionTable& solution, const TruthSeries& truth);

/// The points of a reference that a solution is compared with.
struct ComparedTruth {
  TruthSeries points;
  bool at_solution_rows = false;  ///< interpolated to these
};

/// Those of CompareWithTruth below.
ComparedTruth TruthToCompare(const SolutionTable& solution,
                             const TruthSeries& truth,
                             const TrajectoryErrorOptions& options);

/// What CompareWithTruth finds.
struct TruthComparison {
  ComparedTruth truth;
  std::vector<TrajectoryError> errors;
  TrajectoryStatistics statistics;
};

/// The errors of a solution against a reference, of whatever command asks:
///   where the solution has a row at every (thinned) truth point in its span,
///       there; `run` samples its solutions so, through the IMU
///   else where the truth is the denser of the two (its points on average at
///       least half as far again as close), at the solution's rows, the truth
///       interpolated: a row a second says too little of a turn in between
///   else at the (thinned) truth points, the solution interpolated.
/// Interpolation as of TrajectoryInterpolator, with the gap of the options.
TruthComparison CompareWithTruth(const SolutionTable& solution,
                                 const TruthSeries& truth,
                                 const TrajectoryErrorOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_TRUTH_COMPARISON_H_
