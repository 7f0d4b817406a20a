#include "problems/reconstruction.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "evaluation/trajectory_error.h"
#include "io/config/scenario_config.h"

namespace hindsight {
namespace {

/// One minute of the car drive; truth at every IMU sample.
Dataset Drive(std::uint64_t seed = 1) {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 60.0;
  scenario.truth_rate_hz = scenario.imu_rate_hz;
  scenario.withholdings.clear();
  return Simulate(scenario, seed);
}

constexpr const char* kMethods[] = {"ekf", "rts", "iterated", "batch"};

TEST(Reconstruction, EveryMethodReconstructsAShortDrive) {
  const Dataset dataset = Drive();
  Reconstruction reconstruction(dataset, {});
  for (const std::string method : kMethods) {
    const Solution solution = reconstruction.Run(method);
    EXPECT_EQ(solution.method, method);
    EXPECT_TRUE(solution.usable()) << solution.verdict;
    EXPECT_TRUE(solution.converged);
    ASSERT_EQ(solution.covariances.size(), solution.states.size());
    const TrajectoryStatistics statistics =
        EvaluateTrajectory(TableFromSolution(solution), dataset.truth, {});
    // Fixes of 5 cm a second apart.
    EXPECT_LT(statistics.position->horizontal.rms, 0.1) << solution.method;
    EXPECT_LT(statistics.position->horizontal.max, 0.4) << solution.method;
  }
}

TEST(Reconstruction, TwoRunsGiveIdenticalBits) {
  const Dataset dataset = Drive();
  Reconstruction first(dataset, {});
  Reconstruction second(dataset, {});
  // In another order: methods do not disturb each other.
  const Solution a = first.Run("batch");
  second.Run("iterated");
  const Solution b = second.Run("batch");
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    EXPECT_EQ(a.states[k].p_e, b.states[k].p_e) << k;
    EXPECT_EQ(a.covariances.Get(k), b.covariances.Get(k)) << k;
  }
}

TEST(Reconstruction, StopInterrupts) {
  const Dataset dataset = Drive();
  const std::atomic<bool> stop = true;
  ReconstructionOptions options;
  options.stop = &stop;
  EXPECT_THROW(Solve(dataset, options), Interrupted);
}

TEST(Reconstruction, WithoutAidingTheUnobservedStatesAreNamed) {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 600.0;
  scenario.withholdings.clear();
  Dataset dataset = Simulate(scenario, 1);
  dataset.streams.clear();
  // Started as if on a consumer IMU that nobody aligned.
  dataset.initial.attitude_sigma = Eigen::Vector3d::Constant(10.0 * kDegree);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(1e-3);
  const Solution solution = Solve(dataset, {});
  EXPECT_FALSE(solution.usable());
  ASSERT_FALSE(solution.unobserved.empty());
  EXPECT_NE(solution.verdict.find("not observed from"), std::string::npos)
      << solution.verdict;
  bool north = false;
  for (const UnobservedSpan& span : solution.unobserved) {
    EXPECT_LE(span.t_begin, span.t_end);
    if (span.component != "position[north]") continue;
    north = true;
    EXPECT_GT(span.sigma, 1000.0);
    EXPECT_NEAR(span.t_end, solution.states.back().t, 1e-9);
  }
  EXPECT_TRUE(north);
}

TEST(Reconstruction, EveryMethodSaysWhatItCost) {
  const Dataset dataset = Drive();
  Reconstruction reconstruction(dataset, {});
  const double ekf = reconstruction.Run("ekf").seconds;
  // It filters the same data once.
  EXPECT_GT(reconstruction.Run("gated_ekf").seconds, 0.1 * ekf);
  EXPECT_GT(ekf, 1e-4);
}

TEST(Sample, BetweenNodesIsAsGoodAsANodeThere) {
  const Dataset dataset = Drive();
  std::vector<double> times;
  for (double t = 10.25; t < 50.0; t += 1.0) times.push_back(t);
  Reconstruction coarse(dataset, {});
  ReconstructionOptions options;
  options.node_times = times;
  Reconstruction fine(dataset, options);
  const Solution sampled = coarse.Sample(coarse.Run("batch"), times);
  const Solution exact = fine.Sample(fine.Run("batch"), times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const ErrorVector d =
        Local(exact.layout, exact.states[i], sampled.states[i]);
    // The jump at the next node, spread linearly, against the smoother's own
    // cubic: the noise of one second, 0.8 mm/s and 0.3 mm.
    EXPECT_LT(d.head<3>().norm(), 2e-3) << times[i];
    EXPECT_LT(d.segment<3>(3).norm(), 5e-3) << times[i];
    EXPECT_LT(d.segment<3>(6).norm(), 1e-4) << times[i];
  }
}

TEST(Sample, TimesOutsideTheSolutionAreAnInputError) {
  const Dataset dataset = Drive();
  Reconstruction reconstruction(dataset, {});
  const Solution solution = reconstruction.Run("rts");
  EXPECT_THROW(reconstruction.Sample(solution, {-5.0}), InputError);
  EXPECT_THROW(reconstruction.Sample(solution, {10.0, 1e6}), InputError);
  EXPECT_TRUE(reconstruction.Sample(solution, {}).states.empty());
}

TEST(MountingSigma, TurnsWithTheBodyAndLeavesTheRest) {
  const Dataset dataset = Drive();
  Solution solution = Reconstruction(dataset, {}).Run("rts");
  const Eigen::Vector3d sigma_b(0.01, 0.02, 0.03);
  const Solution widened = WithMountingSigma(solution, sigma_b);
  const int at = solution.layout.Find(BlockKind::kAttitude)->offset;
  for (std::size_t k = 0; k < solution.states.size(); k += 7) {
    ErrorMatrix added = widened.covariances.Get(k);
    added -= solution.covariances.Get(k);
    const State& x = solution.states[k];
    const Eigen::Matrix3d C_bn =
        x.q_eb.toRotationMatrix().transpose() * x.C_en();
    const Eigen::Matrix3d in_body =
        C_bn * added.block<3, 3>(at, at) * C_bn.transpose();
    EXPECT_LT((in_body - Eigen::Matrix3d(sigma_b.cwiseAbs2().asDiagonal()))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    added.block<3, 3>(at, at).setZero();
    EXPECT_EQ(added.cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST(MoveToPoint, CovarianceMatchesNumericDifference) {
  const Dataset dataset = Drive();
  Reconstruction reconstruction(dataset, {});
  Solution solution = reconstruction.Run("rts");
  const std::size_t k = solution.states.size() / 2;
  solution.states = {solution.states[k]};
  const ErrorMatrix P = solution.covariances.Get(k);
  solution.covariances = CovarianceSeries(solution.layout.dim(), 1);
  solution.covariances.Set(0, P);
  const Eigen::Vector3d l_b(1.5, -0.8, -1.2);
  const Solution moved = MoveToPoint(solution, dataset.imu, l_b);
  const State& at = moved.states[0];
  const State& x = solution.states[0];
  EXPECT_NEAR((at.p_e - x.p_e).norm(), l_b.norm(), 3e-9);
  const int n = solution.layout.dim();
  Eigen::MatrixXd J(n, n);
  for (int c = 0; c < n; ++c) {
    const double h = c < 3 ? 1.0 : 1e-4;
    const auto after = [&](double step) {
      ErrorVector d = ErrorVector::Zero(n);
      d(c) = step;
      Solution shifted = solution;
      shifted.states[0] = Retract(solution.layout, x, d);
      const State y = MoveToPoint(shifted, dataset.imu, l_b).states[0];
      return Local(solution.layout, at, y);
    };
    J.col(c) = (after(h) - after(-h)) / (2.0 * h);
  }
  const Eigen::MatrixXd expected = J * P * J.transpose();
  const ErrorMatrix actual = moved.covariances.Get(0);
  const Eigen::VectorXd s = expected.diagonal().cwiseSqrt().cwiseInverse();
  // Rounding of positions over 2e-4, and the Earth's rate on the lever arm.
  EXPECT_LT((s.asDiagonal() * (actual - expected) * s.asDiagonal())
                .cwiseAbs()
                .maxCoeff(),
            2e-4);
}

}  // namespace
}  // namespace hindsight
