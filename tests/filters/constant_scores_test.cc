#include "filters/constant_scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/chi_square.h"
#include "earth/wgs84.h"
#include "filters/forward_filter.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

constexpr double kFalse = 0.01;
constexpr double kSigma = 0.05;

/// A drive of which the fixes have errors correlated over `tau`, with the
/// variance that is stated for them as white noise; zero: white.
TestProblem LeverArmDrive(std::uint64_t seed, double tau) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  Block arm;
  arm.key = {BlockKind::kLeverArm, 0};
  arm.name = "lever_arm";
  arm.unit = "m";
  arm.evolution = Evolution::Constant();
  arm.sigma0.setConstant(0.3);
  options.layout.Add(arm);
  options.errors = true;
  options.duration = 300.0;
  options.spacing = 0.5;
  options.position_sigma = kSigma;
  options.velocity_sigma = 0.0;
  TestProblem problem = MakeProblem(options, seed);
  if (tau <= 0.0) return problem;
  Random random(seed + 1000);
  const double keep = std::exp(-options.spacing / tau);
  Eigen::Vector3d error = kSigma * random.NormalVector3();
  for (std::size_t k = 0; k < problem.nodes.size(); ++k) {
    const State& x = problem.truth[k];
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    const Eigen::Vector3d p =
        x.p_e + x.q_eb.toRotationMatrix() * testing::AntennaLeverArm();
    fix.p_e = p + NedAxes(p) * error;
    error = keep * error +
            std::sqrt(1.0 - keep * keep) * kSigma * random.NormalVector3();
  }
  return problem;
}

std::vector<int> LeverArm(const ErrorLayout& layout) {
  const Block* block = layout.Find(BlockKind::kLeverArm, 0);
  return {block->offset, block->offset + 1, block->offset + 2};
}

struct Estimate {
  Eigen::Vector3d error, sigma;
  std::vector<double> factor;
};

Estimate EstimateArm(const TestProblem& problem) {
  Problem posed = problem.Pose();
  const LinearTape tape = RunLinearizedFilter(problem.truth, &posed);
  const std::vector<int> arm = LeverArm(problem.layout);
  Estimate out;
  out.factor = ExcessOfConstants(tape, arm, kFalse);
  // Linear about the truth: what is left is the error.
  out.error = tape.back().dx_plus.segment<3>(arm.front());
  out.sigma = tape.P_plus(tape.size() - 1)
                  .diagonal()
                  .segment<3>(arm.front())
                  .cwiseSqrt();
  return out;
}

TEST(ConstantScores, OfARightModelWidenNothing) {
  constexpr int kRuns = 60;
  int widened = 0;
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<double> factors =
        EstimateArm(LeverArmDrive(20 + static_cast<unsigned>(run), 0.0)).factor;
    if (*std::max_element(factors.begin(), factors.end()) > 1.0) ++widened;
  }
  // One in a hundred runs at most; of sixty more than three are one in three
  // hundred.
  EXPECT_LE(widened, 3);
}

TEST(ConstantScores, CoverTheErrorsOfCorrelatedFixes) {
  constexpr int kRuns = 30;
  double stated = 0.0, covered = 0.0;
  int widened = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Estimate arm =
        EstimateArm(LeverArmDrive(500 + static_cast<unsigned>(run), 2.0));
    for (int axis = 0; axis < 3; ++axis) {
      const double z = arm.error(axis) / arm.sigma(axis);
      const double factor = arm.factor[static_cast<std::size_t>(axis)];
      stated += z * z;
      covered += z * z / (factor * factor);
      if (factor > 1.0) ++widened;
    }
  }
  const double dof = 3.0 * kRuns;
  EXPECT_GT(stated, ChiSquareQuantile(0.999, dof));
  EXPECT_LT(covered, ChiSquareQuantile(0.999, dof));
  EXPECT_GT(widened, 2 * kRuns);
}

}  // namespace
}  // namespace hindsight
