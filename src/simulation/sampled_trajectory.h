#ifndef HINDSIGHT_SIMULATION_SAMPLED_TRAJECTORY_H_
#define HINDSIGHT_SIMULATION_SAMPLED_TRAJECTORY_H_

#include <vector>

#include "simulation/trajectory.h"

namespace hindsight {

/// One line of a motion profile.
struct ProfilePoint {
  double t = 0.0;  ///< [s]
  Geodetic position;
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();    ///< NED [m/s]
  Eigen::Vector3d euler = Eigen::Vector3d::Zero();  ///< roll, pitch, heading
};

/// A motion made smooth and consistent from a table of velocity and attitude,
/// such as the profiles published with Groves (2013). Velocity in e is a cubic
/// Hermite interpolant with the slopes of a parabola through each three points;
/// position is its integral from the first point of the table (the table's own
/// positions are rounded too coarsely to differentiate); attitude is a cubic
/// Hermite interpolant of the rotation vector within each interval. Velocity
/// and attitude pass through the points, acceleration and body rate are
/// continuous.
class SampledTrajectory : public Trajectory {
 public:
  /// Throws InputError if there are fewer than three points or times do not
  /// ascend, naming the point (counted from 1).
  explicit SampledTrajectory(const std::vector<ProfilePoint>& points);

  double t_begin() const override { return nodes_.front().t; }
  double t_end() const override { return nodes_.back().t; }
  Motion At(double t) override;

  /// Largest distance between this motion and the table's positions [m].
  double largest_position_deviation() const { return largest_deviation_; }

 private:
  std::vector<Motion> nodes_;
  double largest_deviation_ = 0.0;
  std::size_t hint_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_SAMPLED_TRAJECTORY_H_
