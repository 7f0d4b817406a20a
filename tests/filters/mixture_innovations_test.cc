#include "filters/mixture_innovations.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "base/chi_square.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

constexpr double kPoor = 20.0;

TestProblem SeededProblem(std::uint64_t seed) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 120.0;
  options.position_sigma = 0.5;
  return MakeProblem(options, seed);
}

/// Fixes whose noise is as stated or kPoor times as large, as a Markov chain
/// says that stays with probability 0.9.
TestProblem SwitchingProblem(std::uint64_t seed) {
  TestProblem problem = SeededProblem(seed);
  Random random(seed + 100000);
  bool poor = random.Uniform() < 0.5;
  double t = -1.0;
  for (Measurement& z : problem.measurements) {
    if (z.t > t && random.Uniform() < 0.1) poor = !poor;
    t = z.t;
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || !poor) continue;
    // With the noise that is there the variance is kPoor^2 times the stated.
    const Eigen::Vector3d more =
        std::sqrt(fix->R_n(0, 0) * (kPoor * kPoor - 1.0)) *
        random.NormalVector3();
    fix->p_e += NedAxes(fix->p_e) * more;
  }
  return problem;
}

ImmResult Filtered(const TestProblem& problem, double factor) {
  Problem posed = problem.Pose();
  ImmOptions options;
  options.transition = StayingTransition(2, 0.9);
  options.start = Eigen::Vector2d(0.5, 0.5);
  return RunImm({{"good", problem.layout, problem.prior, {1.0, 1.0}},
                 {"poor", problem.layout, problem.prior, {factor, 1.0}}},
                options, &posed.timeline);
}

/// Sums of the scores of one row of a sensor over `length` in a row.
std::vector<double> Sums(const ImmTape& tape, int sensor, int row,
                         std::size_t length) {
  std::vector<double> sums;
  std::size_t count = 0;
  for (const MixtureInnovation& one : MixtureInnovations(tape)) {
    const TapeMeasurement& z =
        tape.tapes[0].measurements(one.epoch)[one.measurement];
    if (z.sensor != sensor) continue;
    if (count++ % length == 0) sums.push_back(0.0);
    sums.back() += one.scores(row);
  }
  if (count % length != 0) sums.pop_back();
  return sums;
}

TEST(MixtureInnovations, OfOneModelAreItsWhitenedInnovations) {
  const TestProblem problem = SeededProblem(3);
  Problem posed = problem.Pose();
  const ImmResult imm =
      RunImm({{"", problem.layout, problem.prior, {}}}, {}, &posed.timeline);
  const std::vector<MixtureInnovation> all = MixtureInnovations(imm.tape);
  ASSERT_EQ(all.size(), problem.measurements.size());
  for (const MixtureInnovation& one : all) {
    const TapeMeasurement& z =
        imm.tape.tapes[0].measurements(one.epoch)[one.measurement];
    const Eigen::VectorXd white =
        Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation);
    EXPECT_LT((one.scores - white).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(MixtureInnovations, OfEqualModelsAreThoseOfOne) {
  const TestProblem problem = SeededProblem(4);
  const ImmResult imm = Filtered(problem, 1.0);
  for (const MixtureInnovation& one : MixtureInnovations(imm.tape)) {
    const TapeMeasurement& z =
        imm.tape.tapes[0].measurements(one.epoch)[one.measurement];
    const Eigen::VectorXd white =
        Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation);
    EXPECT_LT((one.scores - white).cwiseAbs().maxCoeff(), 1e-6);
  }
}

/// Independent N(0, 1) of what the models generate: mean squares of sums of
/// every length are within the bounds of their chi-square distribution.
TEST(MixtureInnovations, OfRightModelsAreIndependentStandardNormal) {
  constexpr int kSeeds = 20;
  struct Mean {
    int sensor;
    std::size_t length;
    double squares = 0.0;
    int count = 0;
  };
  std::vector<Mean> means;
  for (const int sensor : {0, 1}) {
    for (const std::size_t length : {1U, 4U, 16U}) {
      means.push_back({sensor, length});
    }
  }
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ImmResult imm = Filtered(SwitchingProblem(seed), kPoor);
    for (Mean& mean : means) {
      for (int row = 0; row < 3; ++row) {
        for (const double sum : Sums(imm.tape, mean.sensor, row, mean.length)) {
          mean.squares += sum * sum / static_cast<double>(mean.length);
          ++mean.count;
        }
      }
    }
  }
  for (const Mean& mean : means) {
    ASSERT_GT(mean.count, 100);
    const Interval bounds = AneesBounds(mean.count, 1, 0.999);
    EXPECT_GT(mean.squares / mean.count, bounds.lower)
        << mean.sensor << " " << mean.length;
    EXPECT_LT(mean.squares / mean.count, bounds.upper)
        << mean.sensor << " " << mean.length;
  }
}

/// An error that no model has: the sums grow with their length.
TEST(MixtureInnovations, OfAnErrorThatLastsAddUp) {
  TestProblem problem = SeededProblem(5);
  for (Measurement& z : problem.measurements) {
    auto* fix = std::get_if<VelocityFix>(&z.model);
    if (fix != nullptr && z.t > 30.0 && z.t < 62.0) fix->v_n.x() += 0.2;
  }
  const ImmResult imm = Filtered(problem, kPoor);
  double squares = 0.0;
  const std::vector<double> sums = Sums(imm.tape, 1, 0, 16);
  for (const double sum : sums) squares += sum * sum / 16.0;
  EXPECT_GT(squares / static_cast<double>(sums.size()),
            AneesBounds(static_cast<int>(sums.size()), 1, 0.999999).upper);
}

}  // namespace
}  // namespace hindsight
