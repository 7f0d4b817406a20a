#include "problems/marginal_likelihood.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "problems/forward_stage.h"
#include "support/shuttle_flight.h"

namespace hindsight {
namespace {

MarginalLikelihood LikelihoodOf(double position_sigma, double imu_factor) {
  Scenario scenario = ShuttleFlight({}, 5);
  scenario.imu.noise.gyro_noise_density *= imu_factor;
  scenario.imu.noise.accel_noise_density *= imu_factor;
  scenario.aiding[0].sigma.setConstant(position_sigma);
  const Dataset dataset = Simulate(scenario, 5);
  ForwardStage stage(dataset, {});
  stage.Run();
  const std::vector<State>& nominal = stage.smoothed().states;
  const GateDecisions used(stage.timeline().all_measurements().size(), 1);
  return MarginalLikelihoodOf(
      stage.start().layout,
      PriorOfComparison(dataset, stage.start(), nominal.front()), nominal,
      stage.decisions(), used, &stage.timeline());
}

/// What two predictions have of the IMU's noise: nothing of an exact one; all
/// that positions can show, less what start and biases take up, where they are
/// exact themselves.
TEST(MarginalLikelihood, CountsWhatTheMeasurementsKnowOfTheImuNoise) {
  const MarginalLikelihood exact_imu = LikelihoodOf(0.1, 1e-4);
  EXPECT_LT(exact_imu.imu_noise, 1.0);
  EXPECT_GE(exact_imu.imu_noise, 0.0);
  const MarginalLikelihood usual = LikelihoodOf(0.1, 1.0);
  EXPECT_GT(usual.imu_noise, 20.0);
  EXPECT_LT(usual.imu_noise, 100.0);
  const MarginalLikelihood exact_fixes = LikelihoodOf(1e-6, 1.0);
  constexpr double kStartAndBiases = 15.0;
  EXPECT_LE(exact_fixes.imu_noise, exact_fixes.rows);
  EXPECT_GT(exact_fixes.imu_noise, exact_fixes.rows - kStartAndBiases - 1.0);
}

TEST(MarginalLikelihood, WhitensAsManyInnovationsAsItCounts) {
  const MarginalLikelihood usual = LikelihoodOf(0.1, 1.0);
  double rows = 0.0, squares = 0.0;
  for (const auto& [measurement, innovation] : usual.whitened) {
    rows += static_cast<double>(innovation.size());
    squares += innovation.squaredNorm();
  }
  EXPECT_EQ(rows, usual.rows);
  EXPECT_NEAR(squares, usual.squares, 1e-6 * squares);
}

}  // namespace
}  // namespace hindsight
