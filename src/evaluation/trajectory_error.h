#ifndef HINDSIGHT_EVALUATION_TRAJECTORY_ERROR_H_
#define HINDSIGHT_EVALUATION_TRAJECTORY_ERROR_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/solution_table.h"
#include "evaluation/statistics.h"

namespace hindsight {

struct TrajectoryErrorOptions {
  /// Truth between two solution rows further apart than this is not matched
  /// [s].
  double max_gap = 2.0;
  /// Point the truth speaks of, body axes from the point of the solution [m].
  Eigen::Vector3d truth_lever_arm_b = Eigen::Vector3d::Zero();
  /// Errors of the truth itself, which add to P.
  TruthSigma truth_sigma = {};
};

/// Truth minus solution at the time of one truth point, NED axes at the
/// solution's position. A part is absent where truth or solution lacks it.
struct TrajectoryError {
  double t = 0.0;
  std::optional<Eigen::Vector3d> position;  ///< [m]
  std::optional<Eigen::Vector3d> velocity;  ///< [m/s]
  /// Differences of (roll, pitch, heading), each in (-pi, pi] [rad].
  std::optional<Eigen::Vector3d> euler;
  /// Rotation vector psi, C_nb(truth) = Exp(psi) C_nb(solution) [rad].
  std::optional<Eigen::Vector3d> rotation;
  /// Normalised squared errors e' (P + R)^-1 e, 3 degrees of freedom each, R of
  /// the truth's own error. With a lever arm P is still that of the solution's
  /// own point.
  std::optional<double> position_nees;
  std::optional<double> velocity_nees;
  std::optional<double> attitude_nees;
};

/// Errors at all truth points that can be matched. The solution is
/// interpolated to the truth's times (see TrajectoryInterpolator).
std::vector<TrajectoryError> ComputeTrajectoryErrors(
    const SolutionTable& solution, const TruthSeries& truth,
    const TrajectoryErrorOptions& options);

struct VectorErrorStatistics {
  std::array<ErrorStatistics, 3> axis;  ///< north, east, down
  ErrorStatistics horizontal;           ///< of the length in the plane
  ErrorStatistics total;                ///< of the length
};

struct AttitudeErrorStatistics {
  std::array<ErrorStatistics, 3> axis;  ///< roll, pitch, heading [rad]
  ErrorStatistics tilt;   ///< rotation about a horizontal axis [rad]
  ErrorStatistics total;  ///< angle of the rotation [rad]
};

/// Statistics of a whole trajectory; a part is absent where no truth point
/// could be compared.
struct TrajectoryStatistics {
  /// What the figures are taken at: truth points, or with `at_solution_rows`
  /// the rows of the solution.
  bool at_solution_rows = false;
  std::size_t truth_count = 0;  ///< such points
  std::size_t matched_count = 0;
  /// Points compared, of all there are [%].
  double matched_percent() const;
  std::optional<VectorErrorStatistics> position;  ///< [m]
  std::optional<VectorErrorStatistics> velocity;  ///< [m/s]
  std::optional<AttitudeErrorStatistics> attitude;
  /// Horizontal error at the last point compared [m], and the way of the truth
  /// between the first and that [m].
  std::optional<double> final_horizontal;
  std::optional<double> distance;
  std::optional<double> position_nees;  ///< mean over the points
  std::optional<double> velocity_nees;
  std::optional<double> attitude_nees;
  /// Part of the points whose normalised squared attitude error is below the
  /// chi-square quantile of 99.73 %, the 3-sigma of one axis.
  std::optional<double> attitude_inside;
};

TrajectoryStatistics SummarizeErrors(const std::vector<TrajectoryError>& errors,
                                     std::size_t truth_count);

/// The same of the errors against a whole truth, with final_horizontal and distance.
TrajectoryStatistics SummarizeErrors(const std::vector<TrajectoryError>& errors,
                                     const TruthSeries& truth);

/// Both steps in one.
TrajectoryStatistics EvaluateTrajectory(const SolutionTable& solution,
                                        const TruthSeries& truth,
                                        const TrajectoryErrorOptions& options);

/// What a truth says against the covariances of a solution, in words: mean
/// normalised squared errors above 100, where 3 is right. Empty if there is
/// nothing.
std::string Contradiction(const TrajectoryStatistics& statistics);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_TRAJECTORY_ERROR_H_
