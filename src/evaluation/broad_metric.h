#ifndef HINDSIGHT_EVALUATION_BROAD_METRIC_H_
#define HINDSIGHT_EVALUATION_BROAD_METRIC_H_

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/solution_table.h"

namespace hindsight {

/// Errors of one attitude as the BROAD benchmark counts them (Laidig, Caruso,
/// Cereatti and Seel, "BROAD - A Benchmark for Robust Inertial Orientation
/// Estimation", Data 2021, section 4): with q_e = q_est * conj(q_ref) in axes
/// whose z is vertical,
///   total = 2 acos |w|,  heading = 2 atan |z / w|,
///   inclination = 2 acos sqrt(w^2 + z^2).  All in rad.
struct BroadError {
  double total = 0.0;
  double heading = 0.0;
  double inclination = 0.0;
};
BroadError BroadErrorOf(const Eigen::Quaterniond& q_est,
                        const Eigen::Quaterniond& q_ref);

/// Root mean squares over the reference points in motion (all if the reference
/// does not say) that have an attitude and lie within the solution. The
/// benchmark's reference is aligned with magnetic north already: nothing is
/// fitted.
struct BroadMetric {
  BroadError rms;
  std::size_t count = 0;
};
/// `solution` is interpolated to the reference's times.
BroadMetric EvaluateBroad(const SolutionTable& solution,
                          const TruthSeries& truth);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_BROAD_METRIC_H_
