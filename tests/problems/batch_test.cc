#include "problems/batch.h"

#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "base/error.h"
#include "filters/iterated_smoother.h"
#include "problems/chain_problem.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::LargestError;
using testing::MakeProblem;
using testing::RichLayout;
using testing::ScaledDifference;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

struct Kind {
  bool rich = false;
  bool walk = true;  ///< of the biases; otherwise they are in the border
};
constexpr Kind kKinds[] = {{false, true}, {false, false}, {true, true}};

TestProblem ShortDrive(const Kind& kind, double duration = 20.0,
                       bool errors = true) {
  TestProblemOptions options;
  options.noise = TacticalNoise(kind.walk);
  // One gate decision for all: nothing is rejected.
  options.layout =
      kind.rich ? RichLayout(options.noise) : TypicalLayout(options.noise);
  options.duration = duration;
  options.errors = errors;
  return MakeProblem(options, 11);
}

std::string Name(const Kind& kind) {
  return std::string(kind.rich ? "rich" : "plain") +
         (kind.walk ? ", walking" : ", constant");
}

GateDecisions All(const TestProblem& problem) {
  return GateDecisions(problem.measurements.size(), 1);
}

std::vector<State> FilteredStates(Problem* posed) {
  return SmoothRts(RunExtendedKalmanFilter(posed)).states;
}

/// A trajectory whose constants are the same everywhere, as the batch's are.
std::vector<State> NominalOf(const TestProblem& problem, double size) {
  std::vector<State> nominal = problem.truth;
  Random random(21);
  ErrorVector first;
  for (State& x : nominal) {
    ErrorVector d =
        size * testing::Draw(problem.layout.InitialCovariance(), &random);
    if (first.size() == 0) first = d;
    for (const Block& block : problem.layout.blocks()) {
      if (block.evolution.is_constant()) {
        d.segment(block.offset, block.dim) =
            first.segment(block.offset, block.dim);
      }
    }
    x = Retract(problem.layout, x, d);
  }
  for (State& x : nominal) {
    if (problem.layout.Find(BlockKind::kGyroBias)->evolution.is_constant()) {
      x.b_g = nominal.front().b_g;
      x.b_a = nominal.front().b_a;
    }
  }
  return nominal;
}

/// From the second step on factors keep what they work out anew for the first.
TEST(Batch, KeptFactorsAreTheSame) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    ChainProblem chain(NominalOf(problem, 0.1), &posed);
    const ArrowLeastSquares first = chain.GaussNewtonStep();
    const double cost = chain.linearized_cost();
    const ArrowLeastSquares second = chain.GaussNewtonStep();
    EXPECT_EQ(chain.linearized_cost(), cost) << Name(kind);
    for (int k = 0; k < static_cast<int>(chain.node_count()); ++k) {
      EXPECT_EQ(first.x(k), second.x(k)) << Name(kind) << k;
    }
  }
}

TEST(Batch, HalfAStepLeavesHalf) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    ChainProblem chain(NominalOf(problem, 1e-4), &posed);
    const ArrowLeastSquares step = chain.GaussNewtonStep();
    chain.Apply(step, 0.5);
    const ArrowLeastSquares rest = chain.GaussNewtonStep();
    EXPECT_NEAR(chain.StepSize(rest), 0.5 * chain.StepSize(step),
                1e-3 * chain.StepSize(step))
        << Name(kind);
    EXPECT_NEAR((rest.x_border() - 0.5 * step.x_border()).norm(), 0.0,
                1e-3 * (1e-6 + step.x_border().norm()))
        << Name(kind);
  }
}

TEST(Batch, TakesNoStatesOfAnotherLayout) {
  const TestProblem problem = ShortDrive(kKinds[0]);
  Problem posed = problem.Pose(All(problem));
  std::vector<State> states = NominalOf(problem, 0.1);
  const Eigen::Index count = states.back().parameters.size();
  for (const Eigen::Index other : {count + 1, count - 1}) {
    if (other < 0) continue;
    states.back().parameters.conservativeResize(other);
    EXPECT_THROW(SolveBatch(states, {}, &posed), std::logic_error) << other;
  }
}

TEST(Batch, OneGaussNewtonStepEqualsOneRtsPass) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    const ErrorLayout& layout = problem.layout;
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> nominal = NominalOf(problem, 0.1);
    const SmoothedTrajectory rts =
        SmoothRts(RunLinearizedFilter(nominal, &posed));

    ChainProblem chain(nominal, &posed);
    const StateBlocks& blocks = chain.blocks();
    const ArrowLeastSquares arrow = chain.GaussNewtonStep();
    const CovarianceSeries marginals = chain.Marginals(arrow);
    double largest_step = 0.0;
    for (std::size_t k = 0; k < nominal.size(); ++k) {
      const ErrorMatrix P = marginals.Get(k);
      EXPECT_LT(ScaledDifference(rts.P.Get(k), P), 1e-9) << Name(kind) << k;
      ErrorVector step(layout.dim());
      for (const StateBlocks::Entry& entry : blocks.entries()) {
        step.segment(entry.block.offset, entry.block.dim) =
            entry.global
                ? arrow.x_border().segment(entry.tangent, entry.block.dim)
                : arrow.x(static_cast<int>(k))
                      .segment(entry.tangent, entry.block.dim);
      }
      const Eigen::VectorXd sigmas =
          (step - rts.d[k]).cwiseQuotient(P.diagonal().cwiseSqrt());
      EXPECT_LT(sigmas.cwiseAbs().maxCoeff(), 1e-5) << Name(kind) << k;
      largest_step = std::max(largest_step, step.norm());
    }
    EXPECT_GT(largest_step, 0.1);
  }
}

/// An error of a receiver that goes from node to node otherwise down than sideways, and by
/// a rate that acts for longer than between them.
TEST(Batch, GoesByGivenStepsAsTheSmootherDoes) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  Block error;
  error.key = {BlockKind::kSensorError, 0};
  error.evolution = Evolution::GaussMarkov(2.0, 10.0);
  error.sigma0 = Eigen::Vector3d(2.0, 2.0, 0.6);
  options.layout.Add(error);
  Block rate;
  rate.key = {BlockKind::kErrorRate, 0};
  rate.evolution = Evolution::GaussMarkov(0.4, 10.0);
  rate.sigma0.setConstant(0.4);
  options.layout.Add(rate);
  options.duration = 10.0;
  const TestProblem problem = MakeProblem(options, 11);
  Problem posed = problem.Pose(All(problem));
  posed.timeline.SetBlockSteps(
      {problem.nodes.size() - 1,
       {BlockStep{.key = error.key,
                  .phi = 0.9,
                  .variance = 0.76,
                  .rate = rate.key,
                  .rate_share = 1.7,
                  .down = 0.3},
        BlockStep{.key = rate.key, .phi = 0.95, .variance = 0.01}}});
  const SmoothedTrajectory rts =
      SmoothRts(RunLinearizedFilter(problem.truth, &posed));
  ChainProblem chain(problem.truth, &posed);
  const CovarianceSeries marginals = chain.Marginals(chain.GaussNewtonStep());
  const int e = problem.layout.Find(BlockKind::kSensorError, 0)->offset;
  for (std::size_t k = 0; k < problem.truth.size(); ++k) {
    const ErrorMatrix P = marginals.Get(k);
    EXPECT_LT(ScaledDifference(rts.P.Get(k), P), 1e-9) << k;
    EXPECT_LT(P(e + 2, e + 2), 0.5 * P(e, e)) << k;
  }
}

TEST(Batch, ConvergedEqualsTheIteratedSmoother) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> start = FilteredStates(&posed);
    const BatchResult batch = SolveBatch(start, {}, &posed);
    IterationOptions options;
    options.position_tolerance = 1e-8;
    options.attitude_tolerance = 1e-11;
    const IteratedResult iterated = SmoothIterated(start, options, &posed);
    EXPECT_TRUE(batch.converged) << Name(kind);
    const std::vector<State>& a = batch.states;
    const std::vector<State>& b = iterated.trajectory.states;
    EXPECT_LT(LargestError(problem.layout, a, b, BlockKind::kPosition), 1e-6)
        << Name(kind);
    EXPECT_LT(LargestError(problem.layout, a, b, BlockKind::kVelocity), 1e-6)
        << Name(kind);
    EXPECT_LT(LargestError(problem.layout, a, b, BlockKind::kAttitude), 1e-7)
        << Name(kind);
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_LT(ScaledDifference(iterated.trajectory.P.Get(k), batch.P.Get(k)),
                1e-5)
          << Name(kind) << k;
    }
  }
}

TEST(Batch, StartedOneMetreOffReachesAMicrometre) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> near = FilteredStates(&posed);
    std::vector<State> far = near;
    for (State& x : far) x.p_e += Eigen::Vector3d(0.6, -0.5, 0.6);
    const BatchResult a = SolveBatch(near, {}, &posed);
    const BatchResult b = SolveBatch(far, {}, &posed);
    EXPECT_TRUE(b.converged);
    EXPECT_LT(
        LargestError(problem.layout, a.states, b.states, BlockKind::kPosition),
        1e-6)
        << Name(kind);
  }
}

TEST(Batch, WindowsGiveTheSolutionOfTheWholeChain) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    std::vector<State> start = FilteredStates(&posed);
    for (State& x : start) x.p_e += Eigen::Vector3d(0.6, -0.5, 0.6);
    ASSERT_GT(start.size(), 14u);
    const auto solve = [&](std::size_t window_nodes) {
      return SolveBatch(start,
                        {.whole_nodes = window_nodes,
                         .window_nodes = window_nodes,
                         .newton_first = false,
                         .callback = {}},
                        &posed);
    };
    const BatchResult whole = solve(start.size());
    const BatchResult parts = solve(7);
    EXPECT_TRUE(parts.converged) << Name(kind);
    EXPECT_LT(LargestError(problem.layout, whole.states, parts.states,
                           BlockKind::kPosition),
              1e-6)
        << Name(kind);
    EXPECT_LT(LargestError(problem.layout, whole.states, parts.states,
                           BlockKind::kAttitude),
              1e-7)
        << Name(kind);
    for (std::size_t k = 0; k < start.size(); ++k) {
      EXPECT_LT(ScaledDifference(whole.P.Get(k), parts.P.Get(k)), 1e-5)
          << Name(kind) << k;
    }
  }
}

TEST(Batch, NewtonsStepsEndWhereCeresDoes) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    const BatchResult by_ceres =
        SolveBatch(FilteredStates(&posed),
                   {.newton_first = false, .callback = {}}, &posed);
    EXPECT_GT(by_ceres.ceres_iterations, 0);
    for (const double distance : {1e-4, 1e-1, 100.0}) {
      std::vector<State> start = by_ceres.states;
      for (std::size_t k = 0; k < start.size(); k += 2) {
        start[k].p_e.x() += distance;
      }
      for (const std::size_t window : {std::size_t{7}, start.size()}) {
        const BatchResult result = SolveBatch(
            start,
            {.whole_nodes = window, .window_nodes = window, .callback = {}},
            &posed);
        EXPECT_EQ(result.ceres_iterations, 0);
        EXPECT_TRUE(result.converged);
        EXPECT_LT(LargestError(problem.layout, by_ceres.states, result.states,
                               BlockKind::kPosition),
                  1e-6)
            << Name(kind);
        for (std::size_t k = 0; k < start.size(); ++k) {
          EXPECT_LT(ScaledDifference(by_ceres.P.Get(k), result.P.Get(k)), 1e-5)
              << Name(kind) << k;
        }
      }
    }
  }
}

TEST(Batch, NewtonsStepsWithAMixtureEndWhereCeresDoes) {
  for (const Kind& kind : kKinds) {
    TestProblem problem = ShortDrive(kind);
    for (std::size_t i = 4; i < 8; ++i) {
      auto* fix = std::get_if<PositionFix>(&problem.measurements[i].model);
      if (fix != nullptr) fix->p_e.x() += 7.0;
    }
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> start = FilteredStates(&posed);
    for (Sensor& sensor : problem.sensors) {
      sensor.loss.kind = RobustLoss::Kind::kMixture;
      sensor.loss.scale = 1.0;
    }
    Problem mixture = problem.Pose(All(problem));
    const BatchResult by_ceres = SolveBatch(
        start, {.newton_first = false, .graduated = false, .callback = {}},
        &mixture);
    EXPECT_GT(by_ceres.ceres_iterations, 0);
    const BatchResult result =
        SolveBatch(start, {.graduated = false, .callback = {}}, &mixture);
    EXPECT_EQ(result.ceres_iterations, 0) << Name(kind);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(LargestError(problem.layout, by_ceres.states, result.states,
                           BlockKind::kPosition),
              1e-6)
        << Name(kind);
    for (std::size_t k = 0; k < start.size(); ++k) {
      EXPECT_LT(ScaledDifference(by_ceres.P.Get(k), result.P.Get(k)), 1e-5)
          << Name(kind) << k;
    }
  }
}

TEST(Batch, TakesOneStepFromTheSolution) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind);
    Problem posed = problem.Pose(All(problem));
    const BatchResult once = SolveBatch(FilteredStates(&posed), {}, &posed);
    ASSERT_GT(once.iterations, 1) << Name(kind);
    const BatchResult again = SolveBatch(once.states, {}, &posed);
    EXPECT_EQ(again.iterations, 1) << Name(kind);
    EXPECT_TRUE(again.converged);
    EXPECT_LT(LargestError(problem.layout, once.states, again.states,
                           BlockKind::kPosition),
              1e-7)
        << Name(kind);
    for (std::size_t k = 0; k < once.states.size(); ++k) {
      EXPECT_LT(ScaledDifference(once.P.Get(k), again.P.Get(k)), 1e-6)
          << Name(kind) << k;
    }
  }
}

/// From a start that is turned over Newton's steps do not contract.
TEST(Batch, CeresTakesAStartThatNewtonCannot) {
  const TestProblem problem = ShortDrive(kKinds[0]);
  Problem posed = problem.Pose(All(problem));
  std::vector<State> start = FilteredStates(&posed);
  const BatchResult expected = SolveBatch(start, {}, &posed);
  for (State& x : start) {
    x.q_eb = x.q_eb * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY());
  }
  const BatchResult result = SolveBatch(start, {}, &posed);
  EXPECT_GT(result.ceres_iterations, 0);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(LargestError(problem.layout, expected.states, result.states,
                         BlockKind::kPosition),
            1e-6);
}

TEST(Batch, ExactDataGiveZeroError) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind, 20.0, false);
    Problem posed = problem.Pose(All(problem));
    std::vector<State> start = FilteredStates(&posed);
    for (State& x : start) x.p_e += Eigen::Vector3d(0.6, -0.5, 0.6);
    const BatchResult batch = SolveBatch(start, {}, &posed);
    EXPECT_LT(LargestError(problem.layout, batch.states, problem.truth,
                           BlockKind::kPosition),
              1e-6)
        << Name(kind);
    EXPECT_LT(LargestError(problem.layout, batch.states, problem.truth,
                           BlockKind::kAttitude),
              1e-7)
        << Name(kind);
  }
}

TEST(Batch, MarginalsEqualCeresCovariance) {
  for (const Kind& kind : kKinds) {
    const TestProblem problem = ShortDrive(kind, 5.0);
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> states = FilteredStates(&posed);
    const CovarianceSeries marginals = BatchMarginals(states, &posed);

    ChainProblem chain(states, &posed);
    const StateBlocks& blocks = chain.blocks();
    NodeManifold manifold(&blocks);
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem ceres_problem(ownership);
    for (std::size_t k = 0; k < chain.node_count(); ++k) {
      ceres_problem.AddParameterBlock(chain.node_values(k),
                                      blocks.node_ambient_dim(), &manifold);
    }
    for (const auto& factor : chain.factors()) {
      ceres_problem.AddResidualBlock(factor.get(), nullptr,
                                     chain.ParametersOf(*factor));
    }
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.min_reciprocal_condition_number = 1e-40;
    ceres::Covariance covariance(options);
    std::vector<const double*> all;
    for (std::size_t k = 0; k < chain.node_count(); ++k) {
      all.push_back(chain.node_values(k));
    }
    for (std::size_t g = 0; g < blocks.globals().size(); ++g) {
      all.push_back(chain.global_values(g));
    }
    ASSERT_TRUE(covariance.Compute(all, &ceres_problem)) << Name(kind);
    for (std::size_t k = 0; k < chain.node_count(); ++k) {
      std::vector<const double*> own = {chain.node_values(k)};
      for (std::size_t g = 0; g < blocks.globals().size(); ++g) {
        own.push_back(chain.global_values(g));
      }
      const int dim = problem.layout.dim();
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> P(
          dim, dim);
      ASSERT_TRUE(covariance.GetCovarianceMatrixInTangentSpace(own, P.data()));
      // Ceres's order is the node, then the globals; ours the layout's.
      Eigen::VectorXi to_layout(dim);
      for (const StateBlocks::Entry& entry : blocks.entries()) {
        const int first = entry.global ? blocks.node_dim() : 0;
        for (int i = 0; i < entry.block.dim; ++i) {
          to_layout(first + entry.tangent + i) = entry.block.offset + i;
        }
      }
      Eigen::MatrixXd expected(dim, dim);
      for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim; ++j) {
          expected(to_layout(i), to_layout(j)) = P(i, j);
        }
      }
      EXPECT_LT(ScaledDifference(marginals.Get(k), expected), 1e-5)
          << Name(kind) << ", node " << k;
    }
  }
}

TEST(Batch, TwoRunsGiveIdenticalBits) {
  const TestProblem problem = ShortDrive({true, true});
  std::vector<BatchResult> results;
  for (int run = 0; run < 2; ++run) {
    Problem posed = problem.Pose(All(problem));
    const std::vector<State> start = FilteredStates(&posed);
    results.push_back(SolveBatch(start, {}, &posed));
  }
  for (std::size_t k = 0; k < results[0].states.size(); ++k) {
    EXPECT_EQ(results[0].states[k].p_e, results[1].states[k].p_e);
    EXPECT_EQ(results[0].states[k].q_eb.coeffs(),
              results[1].states[k].q_eb.coeffs());
    EXPECT_EQ(results[0].P.Get(k), results[1].P.Get(k));
  }
}

TEST(Batch, WhatTheCallbackThrowsReachesTheCaller) {
  const TestProblem problem = ShortDrive({false, true});
  Problem posed = problem.Pose(All(problem));
  const std::vector<State> start = FilteredStates(&posed);
  BatchOptions options;
  options.callback = [](double) { throw Interrupted(); };
  EXPECT_THROW(SolveBatch(start, options, &posed), Interrupted);
}

}  // namespace
}  // namespace hindsight
