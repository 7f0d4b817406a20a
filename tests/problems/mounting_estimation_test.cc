#include <gtest/gtest.h>

#include <cmath>

#include "alignment/mounting_search.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "support/turned_imu.h"

namespace hindsight {
namespace {

using testing::Constraint;
using testing::kMountings;
using testing::Turned;

AidingStream Level(const Dataset& dataset, int vehicle, double sigma) {
  AidingStream stream;
  stream.sensor.name = "wheels_level";
  stream.sensor.kind = &VehicleLevelKind();
  stream.sensor.vehicle = vehicle;
  stream.sensor.q_sb =
      dataset.streams[static_cast<std::size_t>(vehicle)].sensor.q_sb;
  const int index = static_cast<int>(dataset.streams.size());
  const double duration = dataset.imu.t_end() - dataset.imu.t_begin();
  for (double t = dataset.imu.t_begin(); t < dataset.imu.t_end(); t += 1.0) {
    stream.measurements.push_back(
        {t, index, false, VehicleLevel{sigma * std::sqrt(duration)}});
  }
  return stream;
}

/// The whole way from `unknown`: start value, forward axis, estimate. Yaw and
/// pitch come from the constraint, roll from the stated prior alone.
TEST(MountingEstimation, UnknownMountingIsEstimated) {
  Scenario scenario = FindScenario("short_drive");
  scenario.imu_rate_hz = 50.0;
  scenario.truth_rate_hz = 1.0;
  const Dataset drive = Simulate(scenario, 5);
  for (const Eigen::Quaterniond& q_ob : kMountings) {
    Dataset dataset = Turned(drive, q_ob);
    dataset.streams.push_back(Constraint(dataset));
    const int vehicle = static_cast<int>(dataset.streams.size()) - 1;
    Sensor& wheels = dataset.streams.back().sensor;
    wheels.mounting_unknown = true;
    wheels.mounting_sigma = Eigen::Vector3d::Constant(10.0 * kDegree);
    for (const bool level : {false, true}) {
      if (level) {
        dataset.streams.push_back(Level(dataset, vehicle, 0.5 * kDegree));
      }
      ResolveMountings(&dataset);
      ReconstructionOptions options;
      options.method = "batch";
      const Solution solution = Solve(dataset, options);
      ASSERT_TRUE(solution.converged) << solution.verdict;
      const Eigen::Vector3d m =
          Parameter3(solution.layout, solution.states.back(),
                     BlockKind::kMounting, vehicle, Eigen::Vector3d::Zero());
      const Eigen::Quaterniond estimate =
          Exp(m) *
          dataset.streams[static_cast<std::size_t>(vehicle)].sensor.q_sb;
      const Eigen::Vector3d error = Log(q_ob * estimate.conjugate());
      const Block& block = *solution.layout.Find(BlockKind::kMounting, vehicle);
      const Eigen::Matrix3d J = LeftJacobian(m);
      const Eigen::Matrix3d P =
          J *
          solution.covariances.Get(0).block<3, 3>(block.offset, block.offset) *
          J.transpose();
      EXPECT_LT(std::abs(error.y()), 0.5 * kDegree);
      EXPECT_LT(std::abs(error.z()), 0.5 * kDegree);
      EXPECT_LT(std::abs(error.y()), 4.0 * std::sqrt(P(1, 1)));
      EXPECT_LT(std::abs(error.z()), 4.0 * std::sqrt(P(2, 2)));
      if (level) {
        EXPECT_LT(std::abs(error.x()), 1.5 * kDegree);
        EXPECT_LT(std::sqrt(P(0, 0)), 0.7 * kDegree);
      } else {
        EXPECT_GT(std::sqrt(P(0, 0)), 3.0 * kDegree);
      }
    }
  }
}

/// Positions alone say nothing of a vehicle: the verdict says so.
TEST(MountingEstimation, PositionsAloneLeaveTheMountingUnobserved) {
  Dataset dataset = Simulate(FindScenario("short_drive"), 5);
  AidingStream odometer;
  odometer.sensor.name = "odometer";
  odometer.sensor.kind = &OdometerKind();
  odometer.sensor.mounting_sigma = Eigen::Vector3d::Constant(5.0 * kDegree);
  dataset.streams.push_back(odometer);
  ReconstructionOptions options;
  options.method = "batch";
  const Solution solution = Solve(dataset, options);
  int mountings = 0;
  for (const ConstantEstimate& c : solution.constants) {
    if (!c.name.starts_with("odometer_mounting")) continue;
    ++mountings;
    EXPECT_EQ(c.verdict, ConstantEstimate::Verdict::kUnobserved);
    EXPECT_NEAR(c.sigma, c.prior_sigma, 1e-6);
    EXPECT_EQ(c.value, 0.0);
    EXPECT_FALSE(c.advice.empty());
  }
  EXPECT_EQ(mountings, 3);
}

}  // namespace
}  // namespace hindsight
