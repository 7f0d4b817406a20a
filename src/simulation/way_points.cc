#include "simulation/way_points.h"

#include <algorithm>
#include <cmath>

namespace hindsight {

WayPointPath::WayPointPath(const WayPoints& way) : duration_(way.duration) {
  const double interval =
      way.duration / static_cast<double>(way.points.size() - 1);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& point : way.points) {
      values.push_back(point(axis));
    }
    // The slopes of the first and the last chord, but none downwards.
    const std::size_t n = values.size();
    const double first = axis == 2 ? 0.0 : (values[1] - values[0]) / interval;
    const double last =
        axis == 2 ? 0.0 : (values[n - 1] - values[n - 2]) / interval;
    axes_.emplace_back(values.begin(), values.end(), 0.0, interval, first,
                       last);
  }
}

PathPoint WayPointPath::At(double t) const {
  PathPoint point;
  for (int axis = 0; axis < 3; ++axis) {
    const Spline& spline = axes_[static_cast<std::size_t>(axis)];
    point.p_n(axis) = spline(t);
    point.v_n(axis) = spline.prime(t);
  }
  return point;
}

std::vector<ProfilePoint> WayPointPath::Profile(const Geodetic& start,
                                                double step) const {
  const Eigen::Vector3d p_e = EcefFromGeodetic(start);
  const Eigen::Matrix3d C_en = NedAxes(p_e);
  std::vector<ProfilePoint> points;
  const auto count = static_cast<int>(std::ceil(duration_ / step - 1e-9));
  for (int k = 0; k <= count; ++k) {
    const double t = std::min(k * step, duration_);
    const PathPoint at = At(t);
    ProfilePoint& point = points.emplace_back();
    point.t = t;
    point.position = GeodeticFromEcef(p_e + C_en * at.p_n);
    point.v_n = at.v_n;
    point.euler = {0.0, std::atan2(-at.v_n.z(), at.v_n.head<2>().norm()),
                   std::atan2(at.v_n.y(), at.v_n.x())};
  }
  return points;
}

}  // namespace hindsight
