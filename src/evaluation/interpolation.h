#ifndef HINDSIGHT_EVALUATION_INTERPOLATION_H_
#define HINDSIGHT_EVALUATION_INTERPOLATION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

#include "evaluation/solution_table.h"

namespace hindsight {

/// A trajectory at one instant; what the table does not have is absent.
struct InterpolatedState {
  double t = 0.0;
  std::optional<Eigen::Vector3d> p_e;
  std::optional<Eigen::Vector3d> v_e;
  std::optional<Eigen::Quaterniond> q_eb;
  /// Angular rate of the body over the Earth, body axes [rad/s]; zero without
  /// attitudes and for a table of one row.
  Eigen::Vector3d w_eb_b = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> P_position;  ///< NED, as in SolutionTable
  std::optional<Eigen::Matrix3d> P_velocity;
  std::optional<Eigen::Matrix3d> P_attitude;
};

/// Interpolates a table in time.
///   position   cubic Hermite, slopes from the velocities where they exist
///   velocity, attitude (rotation vector about the row before)
///              cubic with slopes from the neighbouring rows; linear (slerp)
///              where there is no neighbour of comparable distance
///   covariance linear
/// Exact at the rows; in between the error of a smooth motion falls with the
/// third power of the spacing. Where the IMU is at hand, sample the solution
/// through it instead.
class TrajectoryInterpolator {
 public:
  /// Rows further apart than `max_gap` [s] are never bridged. `table` must
  /// outlive the object.
  TrajectoryInterpolator(const SolutionTable& table, double max_gap);

  /// Nothing outside the table's span and inside a gap.
  std::optional<InterpolatedState> At(double t) const;

 private:
  std::optional<std::size_t> FindInterval(double t) const;
  std::optional<InterpolatedState> AtOnlyRow(double t) const;
  void InterpolateMotion(std::size_t k, double h, double u,
                         InterpolatedState* x) const;

  const SolutionTable& table_;
  double max_gap_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_INTERPOLATION_H_
