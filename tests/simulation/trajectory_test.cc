#include "simulation/trajectory.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "simulation/sampled_trajectory.h"
#include "simulation/wandering_drive.h"
#include "state/state.h"

namespace hindsight {
namespace {

MotionProfile Straight(double duration, double speed, double heading) {
  return MotionProfile({Segment::Straight(duration)}, speed, heading);
}

/// p' = v, v' = a, C' = C [w x] by central differences of 2 ms, whose error is
/// h^2/6 of a third derivative.
void ExpectConsistent(Trajectory* trajectory, double t, double tolerance) {
  const double h = 1e-3;
  const Motion a = trajectory->At(t - h);
  const Motion m = trajectory->At(t);
  const Motion b = trajectory->At(t + h);
  // Positions of 6.4e6 m are rounded to 1e-9 m.
  EXPECT_LT(((b.p_e - a.p_e) / (2 * h) - m.v_e).norm(), tolerance + 2e-6) << t;
  EXPECT_LT(((b.v_e - a.v_e) / (2 * h) - m.a_e).norm(), tolerance) << t;
  const Eigen::Vector3d turn = Log(a.q_eb.conjugate() * b.q_eb);
  EXPECT_LT((turn / (2 * h) - m.w_eb_b).norm(), tolerance) << t;
}

TEST(SegmentTrajectory, VelocityAccelerationAndRateAreDerivatives) {
  const Scenario flight = FindScenario("flight");
  SegmentTrajectory trajectory(
      flight.start,
      MotionProfile(flight.segments, flight.start_speed, flight.start_heading),
      100.0);
  for (double t = 0.5; t < 130.0; t += 0.773) {
    ExpectConsistent(&trajectory, t, 1e-5);
  }
}

TEST(SegmentTrajectory, ForwardAxisLiesAlongTheVelocity) {
  SegmentTrajectory trajectory(
      {0.8, 0.2, 100.0}, MotionProfile(WanderingDrive(200.0, 3), 0.0, 1.0),
      100.0);
  for (double t = 1.0; t < 200.0; t += 3.3) {
    const Motion m = trajectory.At(t);
    const Eigen::Vector3d v_b = m.q_eb.conjugate() * m.v_e;
    EXPECT_LT(v_b.tail<2>().norm(), 1e-12 * (1.0 + v_b.norm()));
  }
}

struct GeodesicCase {
  const char* name;
  double latitude_deg, longitude_deg, heading_deg;
};

class Geodesics : public testing::TestWithParam<GeodesicCase> {};

TEST_P(Geodesics, StraightSegmentFollowsTheGeodesic) {
  const GeodesicCase& c = GetParam();
  const double speed = 250.0;
  const double duration = 1800.0;
  SegmentTrajectory trajectory(
      {c.latitude_deg * kDegree, c.longitude_deg * kDegree, 0.0},
      Straight(duration, speed, c.heading_deg * kDegree), 10.0);
  for (const double t : {60.0, 600.0, duration}) {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
    GeographicLib::Geodesic::WGS84().Direct(c.latitude_deg, c.longitude_deg,
                                            c.heading_deg, speed * t,
                                            latitude_deg, longitude_deg);
    const Motion m = trajectory.At(t);
    const Eigen::Vector3d expected = EcefFromGeodetic(
        {latitude_deg * kDegree, longitude_deg * kDegree, 0.0});
    EXPECT_LT((m.p_e - expected).norm(), 1e-6) << t;
    EXPECT_NEAR(m.v_e.norm(), speed, 1e-9) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, Geodesics,
    testing::Values(GeodesicCase{"MidLatitude", 48.0, 11.0, 37.0},
                    GeodesicCase{"OverTheNorthPole", 89.0, 20.0, 0.0},
                    GeodesicCase{"PastTheSouthPole", -89.5, 100.0, 179.0},
                    GeodesicCase{"FromTheNorthPole", 90.0, 30.0, 180.0},
                    GeodesicCase{"AcrossTheDateLine", -17.0, 179.0, 80.0},
                    GeodesicCase{"AlongTheEquator", 0.0, 0.0, 90.0}),
    [](const auto& test) { return test.param.name; });

TEST(SegmentTrajectory, MotionIsSmoothAtThePole) {
  // 250 m/s from 1 km before the pole.
  SegmentTrajectory trajectory({90.0 * kDegree - 1000.0 / 6.4e6, 0.5, 3000.0},
                               Straight(8.0, 250.0, 0.0), 100.0);
  for (double t = 0.1; t < 7.9; t += 0.05) {
    ExpectConsistent(&trajectory, t, 1e-9);
  }
}

TEST(SegmentTrajectory, PositionDoesNotDependOnTheGrid) {
  const MotionProfile profile(WanderingDrive(1800.0, 7), 0.0, 1.0);
  SegmentTrajectory coarse({0.8, 0.2, 100.0}, profile, 50.0);
  SegmentTrajectory fine({0.8, 0.2, 100.0}, profile, 333.0);
  for (double t = 0.0; t <= 1800.0; t += 100.0) {
    EXPECT_LT((coarse.At(t).p_e - fine.At(t).p_e).norm(), 1e-7) << t;
  }
}

TEST(SegmentTrajectory, StepRatesAreIntegratedExactlyOffTheGrid) {
  Segment corner = Segment::Turn(90.0 * kDegree, 45.0 * kDegree);
  corner.blend = 0.0;
  const MotionProfile profile(
      {Segment::Straight(1.01234), corner, Segment::Straight(5.0)}, 20.0, 0.0);
  SegmentTrajectory coarse({0.8, 0.2, 100.0}, profile, 10.0);
  SegmentTrajectory fine({0.8, 0.2, 100.0}, profile, 1000.0);
  EXPECT_LT((coarse.At(6.0).p_e - fine.At(6.0).p_e).norm(), 2e-8);
}

TEST(SegmentTrajectory, TimesMayBeAskedForInAnyOrder) {
  const MotionProfile profile(WanderingDrive(300.0, 9), 0.0, 1.0);
  SegmentTrajectory ascending({0.8, 0.2, 100.0}, profile, 100.0);
  SegmentTrajectory random({0.8, 0.2, 100.0}, profile, 100.0);
  std::vector<double> times;
  for (int k = 0; k <= 1000; ++k) times.push_back(0.3 * k);
  std::vector<Eigen::Vector3d> expected;
  for (const double t : times) expected.push_back(ascending.At(t).p_e);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t j = (k * 577) % times.size();
    EXPECT_EQ(random.At(times[j]).p_e, expected[j]);
  }
}

std::vector<ProfilePoint> SampleProfile(Trajectory* truth, double rate_hz) {
  std::vector<ProfilePoint> points;
  for (int k = 0; k / rate_hz <= truth->t_end(); ++k) {
    const Motion m = truth->At(k / rate_hz);
    State x;
    x.p_e = m.p_e;
    x.v_e = m.v_e;
    x.q_eb = m.q_eb;
    points.push_back({m.t, GeodeticFromEcef(m.p_e), x.v_n(), x.euler()});
  }
  return points;
}

TEST(SampledTrajectory, ReproducesASmoothMotionBetweenItsPoints) {
  const Scenario flight = FindScenario("flight");
  SegmentTrajectory truth(
      flight.start,
      MotionProfile(flight.segments, flight.start_speed, flight.start_heading),
      100.0);
  SampledTrajectory sampled(SampleProfile(&truth, 100.0));
  // Fourth-order interpolation of motions whose third derivative is bounded:
  // slopes err by h^2/6 v''', h = 10 ms.
  for (double t = 0.0; t < 120.0; t += 0.0937) {
    const Motion expected = truth.At(t);
    const Motion m = sampled.At(t);
    EXPECT_LT((m.v_e - expected.v_e).norm(), 1e-6) << t;
    EXPECT_LT(Log(m.q_eb.conjugate() * expected.q_eb).norm(), 1e-6) << t;
    EXPECT_LT((m.p_e - expected.p_e).norm(), 1e-5) << t;
  }
  EXPECT_LT(sampled.largest_position_deviation(), 1e-4);
}

TEST(SampledTrajectory, IsConsistentAndPassesThroughItsPoints) {
  SegmentTrajectory truth({0.8, 0.2, 100.0},
                          MotionProfile(WanderingDrive(60.0, 2), 0.0, 1.0),
                          100.0);
  const std::vector<ProfilePoint> points = SampleProfile(&truth, 20.0);
  SampledTrajectory sampled(points);
  for (std::size_t k = 1; k + 1 < points.size(); k += 17) {
    const Motion m = sampled.At(points[k].t);
    EXPECT_LT((m.v_e - truth.At(points[k].t).v_e).norm(), 1e-9);
    EXPECT_LT(Log(m.q_eb.conjugate() * truth.At(points[k].t).q_eb).norm(),
              1e-9);
    // Across a point and within an interval.
    ExpectConsistent(&sampled, points[k].t + 0.012, 1e-5);
    const Motion before = sampled.At(points[k].t - 1e-9);
    EXPECT_LT((before.a_e - m.a_e).norm(), 1e-6);
    EXPECT_LT((before.w_eb_b - m.w_eb_b).norm(), 1e-6);
  }
}

TEST(SampledTrajectory, RefusesTimesThatDoNotAscend) {
  std::vector<ProfilePoint> points(4);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].t = static_cast<double>(k);
  }
  EXPECT_NO_THROW(SampledTrajectory{points});
  points[2].t = 1.0;
  EXPECT_THROW(SampledTrajectory{points}, InputError);
  points.resize(2);
  EXPECT_THROW(SampledTrajectory{points}, InputError);
}

}  // namespace
}  // namespace hindsight
