#ifndef HINDSIGHT_SIMULATION_WAY_POINTS_H_
#define HINDSIGHT_SIMULATION_WAY_POINTS_H_

#include <Eigen/Core>
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <vector>

#include "simulation/sampled_trajectory.h"

namespace hindsight {

/// Where a vehicle is and how it moves, in level axes (north, east, down) at its
/// start [m], [m/s].
struct PathPoint {
  Eigen::Vector3d p_n;
  Eigen::Vector3d v_n;
};

/// Way-points that are equally spaced in time, in the same axes.
struct WayPoints {
  std::vector<Eigen::Vector3d> points;  ///< at least five, or none [m]
  double duration = 0.0;                ///< from the first to the last [s]
};

/// The cubic spline through way-points, at rest vertically at both ends.
class WayPointPath {
 public:
  explicit WayPointPath(const WayPoints& way);

  double duration() const { return duration_; }
  PathPoint At(double t) const;

  /// The path as a motion profile that starts at `start`: the vehicle looks
  /// along its velocity and does not roll. A point each `step` seconds.
  std::vector<ProfilePoint> Profile(const Geodetic& start, double step) const;

 private:
  using Spline = boost::math::interpolators::cardinal_cubic_b_spline<double>;
  double duration_;
  std::vector<Spline> axes_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_WAY_POINTS_H_
