#include "simulation/uuv_path.h"

#include <cmath>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr double kDiveTime = 1000.0;
constexpr std::size_t kWayPoints = 25;

constexpr double kDepth = 100.0;

/// From the surface along north to the first way-point at depth.
std::vector<Eigen::Vector3d> Dive() {
  return {{0.0, 0.0, 0.0},
          {45.0, 0.0, 12.0},
          {110.0, 0.0, 50.0},
          {185.0, 0.0, 88.0}};
}

std::vector<Eigen::Vector3d> Straight() {
  constexpr double kSpacing = 85.0;
  std::vector<Eigen::Vector3d> points = Dive();
  while (points.size() < kWayPoints - 3) {
    const double north =
        265.0 + kSpacing * static_cast<double>(points.size() - 4);
    points.emplace_back(north, 0.0, kDepth);
  }
  const double end = points.back().x();
  points.emplace_back(end + 75.0, 0.0, 88.0);
  points.emplace_back(end + 140.0, 0.0, 40.0);
  points.emplace_back(end + 195.0, 0.0, 0.0);
  return points;
}

std::vector<Eigen::Vector3d> LawnMower() {
  constexpr int kLanes = 5;
  std::vector<Eigen::Vector3d> points = Dive();
  for (int lane = 0; lane < kLanes; ++lane) {
    const double north = 250.0 + 60.0 * lane;
    for (const double along : {0.0, 100.0, 200.0}) {
      points.emplace_back(north, lane % 2 == 0 ? along : 200.0 - along, kDepth);
    }
  }
  const Eigen::Vector3d end = points.back();
  for (const auto& [on, depth] :
       {std::pair(55.0, 97.0), std::pair(110.0, 80.0), std::pair(165.0, 50.0),
        std::pair(220.0, 22.0), std::pair(270.0, 5.0), std::pair(315.0, 0.0)}) {
    points.emplace_back(end.x() + on, end.y(), depth);
  }
  return points;
}

std::vector<Eigen::Vector3d> Returning() {
  constexpr int kLanes = 6;
  std::vector<Eigen::Vector3d> points = Dive();
  for (int lane = 0; lane < kLanes; ++lane) {
    const double east = 60.0 * lane;
    for (const double along : {0.0, 100.0, 200.0}) {
      const double north = lane % 2 == 0 ? 265.0 + along : 465.0 - along;
      points.emplace_back(north, east, kDepth);
    }
  }
  points.emplace_back(190.0, 300.0, 88.0);
  points.emplace_back(125.0, 300.0, 40.0);
  points.emplace_back(70.0, 300.0, 0.0);
  return points;
}

}  // namespace

UuvPath::UuvPath(const std::vector<Eigen::Vector3d>& way_points,
                 double interval)
    : duration_(interval * static_cast<double>(way_points.size() - 1)) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& point : way_points) {
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

PathPoint UuvPath::At(double t) const {
  PathPoint point;
  for (int axis = 0; axis < 3; ++axis) {
    const Spline& spline = axes_[static_cast<std::size_t>(axis)];
    point.p_n(axis) = spline(t);
    point.v_n(axis) = spline.prime(t);
  }
  return point;
}

std::vector<ProfilePoint> UuvPath::Profile(const Geodetic& start,
                                           double step) const {
  const Eigen::Vector3d p_e = EcefFromGeodetic(start);
  const Eigen::Matrix3d C_en = NedAxes(p_e);
  std::vector<ProfilePoint> points;
  const auto count = static_cast<int>(std::lround(duration_ / step));
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

std::vector<std::string> UuvPathNames() {
  return {"lawnmower", "straight", "returning"};
}

UuvPath MakeUuvPath(const std::string& name) {
  constexpr double kInterval = kDiveTime / (kWayPoints - 1);
  if (name == "lawnmower") return UuvPath(LawnMower(), kInterval);
  if (name == "straight") return UuvPath(Straight(), kInterval);
  if (name == "returning") return UuvPath(Returning(), kInterval);
  throw InputError("unknown path '" + name +
                   "'; known are lawnmower, straight, returning");
}

}  // namespace hindsight
