#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "filters/dense_least_squares.h"
#include "filters/iterated_smoother.h"
#include "filters/two_filter.h"
#include "problems/batch.h"
#include "support/seed_count.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::ScaledDifference;
using testing::SeedCount;
using testing::SolveDense;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// A block of the given kind that walks or forgets as the dice fall. Everything
/// changes a little: the dense normal equations need noise of full rank.
Block RandomBlock(BlockKind kind, int sensor, const std::string& name,
                  double sigma, Random* random) {
  Block block;
  block.key = {kind, sensor};
  block.name = name;
  block.unit = "1";
  block.sigma0.setConstant(sigma * (0.5 + random->Uniform()));
  block.evolution = random->Uniform() < 0.5
                        ? Evolution::RandomWalk(0.02 * sigma)
                        : Evolution::GaussMarkov(
                              block.sigma0.x(), 2.0 + 20.0 * random->Uniform());
  return block;
}

ErrorLayout RandomLayout(const ImuNoise& noise, Random* random) {
  struct Choice {
    BlockKind kind;
    int sensor;
    const char* name;
    double sigma;
  };
  const Choice choices[] = {
      {BlockKind::kGyroScale, BlockKey::kNoSensor, "gyro_scale", 1e-3},
      {BlockKind::kAccelScale, BlockKey::kNoSensor, "accel_scale", 1e-3},
      {BlockKind::kLeverArm, 0, "position_arm", 0.1},
      {BlockKind::kLeverArm, 1, "velocity_arm", 0.1},
      {BlockKind::kColouredNoise, 0, "position_noise", 0.3},
      {BlockKind::kColouredNoise, 1, "velocity_noise", 0.05}};
  ErrorLayout layout = TypicalLayout(noise);
  for (const Choice& c : choices) {
    if (random->Uniform() < 0.5) continue;
    layout.Add(RandomBlock(c.kind, c.sensor, c.name, c.sigma, random));
  }
  return layout;
}

/// The same layout with an axis of every other calibration block masked, which
/// filters and smoothers know and the batch does not.
ErrorLayout Masked(const ErrorLayout& layout) {
  ErrorLayout out;
  std::size_t i = 0;
  for (Block block : layout.blocks()) {
    if (block.key.sensor != BlockKey::kNoSensor && i++ % 2 == 0) {
      block.active[i % 3] = false;
    }
    out.Add(block);
  }
  return out;
}

TestProblem RandomProblem(std::uint64_t seed, bool masked) {
  Random random(seed);
  TestProblemOptions options;
  options.noise.gyro_noise_density = 3e-5 * std::exp(random.Normal());
  options.noise.accel_noise_density = 1e-3 * std::exp(random.Normal());
  options.noise.gyro_bias_walk = 1e-5;
  options.noise.accel_bias_walk = 1e-3;
  if (random.Uniform() < 0.5) options.noise.gyro_bias_tau = 30.0;
  if (random.Uniform() < 0.5) options.noise.accel_bias_tau = 30.0;
  options.layout = RandomLayout(options.noise, &random);
  if (masked) options.layout = Masked(options.layout);
  options.errors = true;
  options.spacing = random.Uniform() < 0.5 ? 1.0 : 0.5;
  options.duration = options.spacing * std::floor(6.0 + 8.0 * random.Uniform());
  options.velocity_sigma = random.Uniform() < 0.3 ? 0.0 : 0.02;
  options.start = MakeState(
      0.0,
      {1.5 * (2.0 * random.Uniform() - 1.0),
       3.1 * (2.0 * random.Uniform() - 1.0), 1000.0 * random.Normal()},
      10.0 * random.NormalVector3(),
      {0.3 * random.Normal(), 0.3 * random.Normal(), 3.0 * random.Uniform()});
  options.start.b_g = 1e-3 * random.NormalVector3();
  options.start.b_a = 0.02 * random.NormalVector3();
  return MakeProblem(options, seed + 1000);
}

/// Largest component of a - b in standard deviations of P.
double InSigmas(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                const Eigen::MatrixXd& P) {
  return (a - b).cwiseQuotient(P.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

struct Smoothers {
  SmoothedTrajectory rts, two_filter;
  testing::DenseSolution dense;
};

Smoothers SmoothAbout(const std::vector<State>& nominal, Problem* posed) {
  const LinearTape tape = RunLinearizedFilter(nominal, posed);
  return {SmoothRts(tape), SmoothTwoFilter(tape).trajectory, SolveDense(tape)};
}

void ExpectSame(const Smoothers& s, int dim) {
  for (std::size_t k = 0; k < s.rts.d.size(); ++k) {
    const Eigen::MatrixXd P = s.dense.CovarianceAt(k, dim);
    const Eigen::VectorXd d = s.dense.At(k, dim);
    // Scaled normal equations of condition 1e10 leave 6 digits.
    EXPECT_LT(ScaledDifference(s.rts.P.Get(k), P), 1e-5) << "rts " << k;
    EXPECT_LT(ScaledDifference(s.two_filter.P.Get(k), P), 1e-5)
        << "two-filter " << k;
    EXPECT_LT(InSigmas(s.rts.d[k], d, P), 1e-4) << "rts " << k;
    EXPECT_LT(InSigmas(s.two_filter.d[k], d, P), 1e-4) << "two-filter " << k;
  }
}

constexpr int kProblems = SeedCount(20);

TEST(RandomProblem, RtsTwoFilterAndDenseLeastSquaresAreOne) {
  for (int seed = 1; seed <= kProblems; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const TestProblem problem =
        RandomProblem(static_cast<std::uint64_t>(seed), seed % 2 == 0);
    Problem posed = problem.Pose();
    std::vector<State> nominal = problem.truth;
    Random random(static_cast<std::uint64_t>(seed));
    for (State& x : nominal) {
      x = Retract(
          problem.layout, x,
          0.1 * testing::Draw(problem.layout.InitialCovariance(), &random));
    }
    ExpectSame(SmoothAbout(nominal, &posed), problem.layout.dim());
  }
}

/// About the batch's own solution every linear smoother finds nothing left to
/// do, and its covariance is that of the batch.
TEST(RandomProblem, AboutTheBatchTheSmoothersStandStill) {
  for (int seed = 1; seed <= kProblems; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const TestProblem problem =
        RandomProblem(static_cast<std::uint64_t>(seed), false);
    Problem posed = problem.Pose(GateDecisions(problem.measurements.size(), 1));
    const std::vector<State> start =
        SmoothRts(RunExtendedKalmanFilter(&posed)).states;
    const BatchResult batch = SolveBatch(start, {}, &posed);
    ASSERT_TRUE(batch.converged);
    const Smoothers s = SmoothAbout(batch.states, &posed);
    for (std::size_t k = 0; k < batch.states.size(); ++k) {
      const Eigen::MatrixXd P = batch.P.Get(k);
      EXPECT_LT(ScaledDifference(s.rts.P.Get(k), P), 1e-5) << k;
      EXPECT_LT(ScaledDifference(s.two_filter.P.Get(k), P), 1e-5) << k;
      EXPECT_LT(InSigmas(s.rts.d[k], Eigen::VectorXd::Zero(P.rows()), P), 1e-3)
          << k;
    }
  }
}

}  // namespace
}  // namespace hindsight
