#include <gtest/gtest.h>

#include <array>
#include <string>

#include "base/chi_square.h"
#include "filters/iterated_smoother.h"
#include "problems/batch.h"
#include "support/seed_count.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;

constexpr int kRuns = testing::SeedCount(100);

/// Sums of normalised squared errors over runs at single epochs: those of one
/// run are correlated over time, those of different runs are independent.
struct Epochs {
  std::array<std::size_t, 3> k;
  std::array<double, 3> sum{};

  void Add(const ErrorLayout& layout, std::size_t epoch, const State& truth,
           const State& x, const ErrorMatrix& P) {
    for (std::size_t i = 0; i < k.size(); ++i) {
      if (k[i] != epoch) continue;
      const ErrorVector e = Local(layout, x, truth);
      const Eigen::VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::LLT<Eigen::MatrixXd> llt(s.asDiagonal() * P *
                                            s.asDiagonal());
      sum[i] += llt.matrixL().solve(s.cwiseProduct(e)).squaredNorm();
    }
  }

  void Expect(int dof, const std::string& name) const {
    const Interval bounds = AneesBounds(kRuns, dof, 0.95);
    for (std::size_t i = 0; i < k.size(); ++i) {
      const double anees = sum[i] / kRuns;
      EXPECT_TRUE(bounds.Contains(anees))
          << name << ", epoch " << k[i] << ": " << anees << " not in ["
          << bounds.lower << ", " << bounds.upper << "]";
    }
  }
};

/// Small enough errors for one linearisation: a fifth of a degree.
TestProblemOptions LinearRegime(bool walk) {
  TestProblemOptions options;
  options.noise = TacticalNoise(walk);
  NavigationPrior prior;
  prior.position_sigma = {0.2, 0.3, 0.4};
  prior.velocity_sigma = {0.05, 0.06, 0.07};
  prior.attitude_sigma = {0.1 * kDegree, 0.1 * kDegree, 0.2 * kDegree};
  prior.gyro_bias_sigma.setConstant(1e-4);
  prior.accel_bias_sigma.setConstant(0.01);
  prior.gyro_bias = options.noise.GyroBiasEvolution();
  prior.accel_bias = options.noise.AccelBiasEvolution();
  options.layout = NavigationLayout(prior);
  options.errors = true;
  return options;
}

void CheckConsistency(bool walk) {
  const TestProblemOptions options = LinearRegime(walk);
  Epochs ekf{{0, 10, 20}};
  Epochs rts{{0, 10, 20}};
  Epochs batch{{0, 10, 20}};
  for (int run = 0; run < kRuns; ++run) {
    const TestProblem problem =
        MakeProblem(options, static_cast<std::uint64_t>(run) + 1);
    Problem posed = problem.Pose();
    const LinearTape tape = RunExtendedKalmanFilter(&posed);
    const SmoothedTrajectory smoothed = SmoothRts(tape);
    posed.decisions = DecisionsOnTape(tape);
    const BatchResult solved = SolveBatch(smoothed.states, {}, &posed);
    for (std::size_t k = 0; k < tape.size(); ++k) {
      ekf.Add(problem.layout, k, problem.truth[k], tape.epoch(k).x_plus,
              tape.P_plus(k));
      rts.Add(problem.layout, k, problem.truth[k], smoothed.states[k],
              smoothed.P.Get(k));
      batch.Add(problem.layout, k, problem.truth[k], solved.states[k],
                solved.P.Get(k));
    }
  }
  const std::string biases = walk ? ", walking biases" : ", constant biases";
  ekf.Expect(15, "forward filter" + biases);
  rts.Expect(15, "RTS smoother" + biases);
  batch.Expect(15, "batch" + biases);
}

TEST(MonteCarlo, AneesWithinBoundsForWalkingBiases) { CheckConsistency(true); }

TEST(MonteCarlo, AneesWithinBoundsForConstantBiases) {
  CheckConsistency(false);
}

}  // namespace
}  // namespace hindsight
