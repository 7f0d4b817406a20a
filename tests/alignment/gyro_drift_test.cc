#include "alignment/gyro_drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "simulation/builtin_scenarios.h"

namespace hindsight {
namespace {

StartReport Found(double walk) {
  StartReport report;
  report.gyro_bias_walk = walk;
  return report;
}

ImuNoise Stated(double walk) {
  ImuNoise noise;
  noise.gyro_bias_walk = walk;
  return noise;
}

TEST(GyroDrift, BeyondTheStatedWalkIsDoubtful) {
  const auto found = FindGyroDrift(Found(0.01 * kDegree), Stated(0.0));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->rule, "gyro_drift");
  EXPECT_EQ(found->grade, Grade::kDoubtful);
  EXPECT_NEAR(*found->value, 0.01 * std::sqrt(60.0), 1e-9);
  EXPECT_NE(found->remedies.at(0).find("gyro_bias_walk: 0.01 deg/s^2/sqrt(Hz)"),
            std::string::npos);
}

TEST(GyroDrift, AWalkThatLetsTheBiasFollowIsUsable) {
  EXPECT_FALSE(FindGyroDrift(Found(0.0), Stated(0.0)));
  EXPECT_FALSE(FindGyroDrift(Found(0.01 * kDegree), Stated(0.003 * kDegree)));
  EXPECT_TRUE(FindGyroDrift(Found(0.01 * kDegree), Stated(0.002 * kDegree)));
}

/// Gyros whose bias changes by a degree a second within 20 s of a drive.
TEST(GyroDrift, IsCarriedFromTheAlignment) {
  Scenario scenario = BuiltinScenario("short_drive");
  scenario.start_speed = 9.0;
  scenario.duration = 100.0;
  scenario.segments = {Segment::Straight(10.0), Segment::Turn(1.5, 0.3),
                       Segment::Straight(10.0), Segment::Turn(-1.5, 0.3),
                       Segment::Straight(60.0)};
  scenario.start_errors.reset();
  scenario.imu.noise.gyro_bias_walk = 0.0;
  const auto walk_of = [](const Dataset& dataset) {
    return FindStart(dataset, dataset.imu.t_begin(), dataset.imu.t_end())
        .report.gyro_bias_walk;
  };
  Dataset dataset = Simulate(scenario, 71);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(0.5 * kDegree);
  EXPECT_EQ(walk_of(dataset), 0.0);
  const bool rates = dataset.imu.kind == ImuStream::Kind::kRates;
  for (ImuSample& sample : dataset.imu.samples) {
    const double bias = -kDegree * std::expm1(-sample.t / 20.0);
    sample.gyro.array() += bias * (rates ? 1.0 : dataset.imu.nominal_dt);
  }
  const double walk = walk_of(dataset);
  EXPECT_GT(walk, 0.0);
  EXPECT_TRUE(FindGyroDrift(Found(walk), dataset.imu.noise));
}

}  // namespace
}  // namespace hindsight
