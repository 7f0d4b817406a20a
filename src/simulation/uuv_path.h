#ifndef HINDSIGHT_SIMULATION_UUV_PATH_H_
#define HINDSIGHT_SIMULATION_UUV_PATH_H_

#include <Eigen/Core>
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <string>
#include <vector>

#include "simulation/sampled_trajectory.h"

namespace hindsight {

/// Where an underwater vehicle is and how it moves, in level axes (north, east,
/// down) at its start [m], [m/s].
struct PathPoint {
  Eigen::Vector3d p_n;
  Eigen::Vector3d v_n;
};

/// The cubic spline through way-points that are equally spaced in time, at rest
/// vertically at both ends.
class UuvPath {
 public:
  /// At least five points, `interval` seconds apart.
  UuvPath(const std::vector<Eigen::Vector3d>& way_points, double interval);

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

/// The paths of the simulated dives, each of 25 way-points in 1000 s, down to
/// 100 m and up again, at 1 to 6 kt (Lee and Yoon 2011, section 4.1; their
/// way-points are not printed, but the turns it names come in four pairs, as
/// between five lanes).
///   lawnmower  north, five lanes of 200 m across, 60 m apart, and on to the
///              north: ten changes of course
///   straight   north alone
///   returning  lawn-mower of six lanes of 200 m that ends 300 m beside its
///              start, which is the farthest but 40 % of the way out
std::vector<std::string> UuvPathNames();
/// Throws InputError for an unknown name.
UuvPath MakeUuvPath(const std::string& name);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_UUV_PATH_H_
