#include "simulation/way_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "io/config/scenario_config.h"

namespace hindsight {
namespace {

constexpr double kKnot = 1852.0 / 3600.0;

WayPointPath DivePath(const std::string& name) {
  return WayPointPath(FindScenario("uuv_survey", {"path=" + name}).way_points);
}

TEST(WayPointPath, PassesThroughItsWayPoints) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 6; ++i) {
    points.emplace_back(10.0 * i, std::sin(i), 2.0 * i * i);
  }
  const WayPointPath path({points, 25.0});
  EXPECT_EQ(path.duration(), 25.0);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(
        (path.At(5.0 * i).p_n - points[static_cast<std::size_t>(i)]).norm(),
        1e-10);
  }
  const double h = 1e-4;
  const Eigen::Vector3d numeric =
      (path.At(7.0 + h).p_n - path.At(7.0 - h).p_n) / (2.0 * h);
  EXPECT_LT((numeric - path.At(7.0).v_n).norm(), 1e-7);
}

TEST(WayPointPath, KeepsToTheSpeedsAndTheDepthOfThePaper) {
  for (const std::string name : {"lawnmower", "straight", "returning"}) {
    const WayPointPath path = DivePath(name);
    EXPECT_NEAR(path.duration(), 1000.0, 1e-9);
    double deepest = 0.0;
    for (double t = 0.0; t <= 1000.0; t += 0.5) {
      const PathPoint at = path.At(t);
      EXPECT_GE(at.v_n.norm(), 1.0 * kKnot) << name << " at " << t;
      EXPECT_LE(at.v_n.norm(), 6.0 * kKnot) << name << " at " << t;
      deepest = std::max(deepest, at.p_n.z());
    }
    EXPECT_NEAR(deepest, 100.0, 5.0) << name;
    EXPECT_NEAR(path.At(1000.0).p_n.z(), 0.0, 1e-9);
  }
}

TEST(WayPointPath, ChangesCourseTenTimes) {
  // A change: the course leaves one of north, east and south by more than 45
  // deg on the way to the next.
  const WayPointPath path = DivePath("lawnmower");
  int changes = 0;
  int quadrant = 0;
  for (double t = 0.0; t <= 1000.0; t += 0.5) {
    const Eigen::Vector3d v = path.At(t).v_n;
    const auto now =
        static_cast<int>(std::lround(std::atan2(v.y(), v.x()) / (0.5 * kPi)));
    if (std::abs(now) != quadrant) ++changes;
    quadrant = std::abs(now);
  }
  EXPECT_EQ(changes, 10);
}

TEST(WayPointPath, ProfileMovesAsThePath) {
  const WayPointPath path = DivePath("lawnmower");
  const Geodetic start{35.0 * kDegree, 129.0 * kDegree, 0.0};
  SampledTrajectory motion(path.Profile(start, 0.5));
  const Eigen::Vector3d p_e = EcefFromGeodetic(start);
  for (const double t : {10.0, 300.3, 999.0}) {
    const Motion at = motion.At(t);
    const Eigen::Vector3d p_n = NedAxes(p_e).transpose() * (at.p_e - p_e);
    EXPECT_LT((p_n - path.At(t).p_n).norm(), 0.1) << t;
    // It looks where it goes.
    const Eigen::Vector3d v_b = at.q_eb.conjugate() * at.v_e;
    EXPECT_LT(v_b.tail<2>().norm(), 2e-3) << t;
  }
}

TEST(WayPointPath, UnknownNameThrows) {
  EXPECT_THROW(DivePath("circle"), InputError);
}

}  // namespace
}  // namespace hindsight
