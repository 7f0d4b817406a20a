#include "alignment/mounting_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "support/turned_imu.h"

namespace hindsight {
namespace {

using testing::Constraint;
using testing::kMountings;
using testing::Turned;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double YawOf(const Eigen::Quaterniond& q) { return Log(q).z(); }

TEST(MountingSearch, FindsAnyAttitudeWithinDegrees) {
  const Dataset drive = Simulate(FindScenario("short_drive"), 3);
  for (const Eigen::Quaterniond& q_ob : kMountings) {
    const Dataset dataset = Turned(drive, q_ob);
    const auto found = FindMounting(dataset, -kInfinity, kInfinity);
    ASSERT_TRUE(found);
    EXPECT_LT(found->q_ob.angularDistance(q_ob), 3.0 * kDegree);
    EXPECT_LT(std::abs(found->lag), 0.11);
    EXPECT_LT(std::abs(YawOf(found->q_ob * q_ob.conjugate())),
              4.0 * found->yaw_sigma + 1.0 * kDegree);
  }
}

TEST(MountingSearch, ToleratesAClockThatIsOff) {
  Dataset dataset = Simulate(FindScenario("short_drive"), 3);
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) z.t -= 0.45;
  }
  const auto found = FindMounting(dataset, -kInfinity, kInfinity);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lag, 0.45, 0.1);
  EXPECT_LT(found->q_ob.angularDistance(Eigen::Quaterniond::Identity()),
            3.0 * kDegree);
}

TEST(MountingSearch, FindsNothingInAStraightLine) {
  Scenario scenario = FindScenario("short_drive");
  scenario.start_speed = 12.0;
  scenario.segments = {Segment::Straight(60.0)};
  const Dataset dataset = Simulate(scenario, 1);
  EXPECT_FALSE(FindMounting(dataset, -kInfinity, kInfinity));
}

TEST(MountingSearch, UnknownWithoutMotionIsSaid) {
  Scenario scenario = FindScenario("short_drive");
  scenario.segments = {Segment::Stop(60.0)};
  Dataset dataset = Simulate(scenario, 1);
  dataset.streams.push_back(Constraint(dataset));
  dataset.streams.back().sensor.mounting_unknown = true;
  EXPECT_THROW(ResolveMountings(&dataset), EstimationError);
}

/// Streams that speak of the same vehicle follow; a mounting that is known well
/// is left alone.
TEST(MountingSearch, FillsInWhatIsUnknown) {
  Dataset dataset =
      Turned(Simulate(FindScenario("short_drive"), 3), kMountings[2]);
  for (int i = 0; i < 2; ++i) dataset.streams.push_back(Constraint(dataset));
  const std::size_t first = dataset.streams.size() - 2;
  dataset.streams[first].sensor.mounting_unknown = true;
  dataset.streams[first + 1].sensor.mounting_sigma =
      Eigen::Vector3d::Constant(2.0 * kDegree);
  AidingStream level;
  level.sensor.kind = &VehicleLevelKind();
  level.sensor.vehicle = static_cast<int>(first);
  dataset.streams.push_back(level);
  ResolveMountings(&dataset);
  const Sensor& found = dataset.streams[first].sensor;
  EXPECT_FALSE(found.mounting_unknown);
  EXPECT_LT(found.q_sb.angularDistance(kMountings[2]), 3.0 * kDegree);
  EXPECT_NEAR(found.mounting_sigma->z(), 10.0 * kDegree, 1e-12);
  EXPECT_EQ(dataset.streams.back().sensor.q_sb.coeffs(), found.q_sb.coeffs());
  EXPECT_EQ(dataset.streams[first + 1].sensor.q_sb.coeffs(),
            Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(dataset.notes.size(), 1u);
}

}  // namespace
}  // namespace hindsight
