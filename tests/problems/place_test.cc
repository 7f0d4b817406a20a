#include <gtest/gtest.h>

#include <string>

#include "filters/iterated_smoother.h"
#include "problems/batch.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::LargestError;
using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem ProblemAt(const Geodetic& place, const Eigen::Vector3d& v_n,
                      bool errors) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.start = MakeState(0.0, place, v_n, {0.05, -0.1, 1.0});
  options.start.b_g = {1e-3, -2e-3, 1.5e-3};
  options.start.b_a = {0.02, 0.03, -0.05};
  // NED axes spin as a pole is passed: velocities in them are no small errors.
  options.velocity_sigma = 0.0;
  options.errors = errors;
  return MakeProblem(options, 31);
}

State Turned(const State& x, double longitude) {
  const Eigen::AngleAxisd turn(longitude, Eigen::Vector3d::UnitZ());
  State y = x;
  y.p_e = turn * x.p_e;
  y.v_e = turn * x.v_e;
  y.q_eb = turn * x.q_eb;
  return y;
}

/// The same problem about the Earth's axis: an exact symmetry.
TestProblem Turned(const TestProblem& problem, double longitude) {
  const Eigen::AngleAxisd turn(longitude, Eigen::Vector3d::UnitZ());
  TestProblem out = problem;
  out.prior.x = Turned(problem.prior.x, longitude);
  for (State& x : out.truth) x = Turned(x, longitude);
  for (Measurement& z : out.measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e = turn * fix.p_e;
  }
  return out;
}

struct Estimates {
  std::vector<State> filter, smoother, batch;
};

Estimates Estimate(const TestProblem& problem) {
  Problem posed = problem.Pose();
  const LinearTape tape = RunExtendedKalmanFilter(&posed);
  Estimates out;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    out.filter.push_back(tape.epoch(k).x_plus);
  }
  out.smoother = SmoothRts(tape).states;
  posed.decisions = DecisionsOnTape(tape);
  const BatchResult batch = SolveBatch(out.smoother, {}, &posed);
  EXPECT_TRUE(batch.converged);
  out.batch = batch.states;
  return out;
}

void ExpectNear(const ErrorLayout& layout, const std::vector<State>& a,
                const std::vector<State>& b, double position, double attitude,
                const std::string& name) {
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kPosition), position) << name;
  EXPECT_LT(LargestError(layout, a, b, BlockKind::kAttitude), attitude) << name;
}

TEST(Place, ExactDataGiveZeroErrorAnywhere) {
  // The third passes within a metre of the pole after one second.
  const Geodetic places[] = {{89.9999 * kDegree, 0.3, 50.0},
                             {-89.9999 * kDegree, -2.0, 50.0},
                             {89.9999 * kDegree, kPi, 50.0},
                             {37.0 * kDegree, kPi - 1e-7, 50.0},
                             {0.0, -kPi + 1e-8, 50.0}};
  for (const Geodetic& place : places) {
    const TestProblem problem = ProblemAt(place, {12.0, 7.0, 0.5}, false);
    const Estimates x = Estimate(problem);
    const std::string name = std::to_string(place.latitude / kDegree);
    ExpectNear(problem.layout, x.filter, problem.truth, 1e-6, 1e-8, name);
    ExpectNear(problem.layout, x.smoother, problem.truth, 1e-6, 1e-8, name);
    ExpectNear(problem.layout, x.batch, problem.truth, 1e-6, 1e-8, name);
  }
}

TEST(Place, TheSameProblemTurnedAboutTheAxisHasTheSameSolution) {
  struct PlaceCase {
    Geodetic place;
    double turn;
  };
  // Over the pole, and from longitude zero to across 180 deg.
  const PlaceCase cases[] = {{{89.9999 * kDegree, 0.0, 50.0}, 1.0},
                             {{37.0 * kDegree, 0.0, 50.0}, kPi - 5e-6},
                             {{-37.0 * kDegree, 0.0, 50.0}, kPi - 5e-6}};
  for (const PlaceCase& c : cases) {
    const TestProblem problem = ProblemAt(c.place, {12.0, 7.0, 0.5}, true);
    const TestProblem turned = Turned(problem, c.turn);
    double low = kPi;
    double high = -kPi;
    for (const State& x : turned.truth) {
      const double longitude = GeodeticFromEcef(x.p_e).longitude;
      low = std::min(low, longitude);
      high = std::max(high, longitude);
    }
    EXPECT_GT(high - low, c.turn == 1.0 ? 0.5 : 6.0) << "crosses nothing";
    const Estimates a = Estimate(problem);
    const Estimates b = Estimate(turned);
    const auto compare = [&](std::vector<State> x, const std::vector<State>& y,
                             const char* name) {
      for (State& state : x) state = Turned(state, c.turn);
      // Rounding, magnified by what weakly observed states leave of it.
      ExpectNear(problem.layout, x, y, 1e-6, 1e-7, name);
    };
    compare(a.filter, b.filter, "forward filter");
    compare(a.smoother, b.smoother, "RTS smoother");
    compare(a.batch, b.batch, "batch");
  }
}

TEST(Place, ErrorsNearThePoleAreThoseElsewhere) {
  const TestProblem polar =
      ProblemAt({89.9999 * kDegree, 0.3, 50.0}, {12.0, 7.0, 0.5}, true);
  const Estimates x = Estimate(polar);
  // Fixes of 5 cm, smoothed; biases and attitude as their priors allow.
  EXPECT_LT(
      LargestError(polar.layout, x.batch, polar.truth, BlockKind::kPosition),
      4.0 * 0.05);
  EXPECT_LT(
      LargestError(polar.layout, x.batch, polar.truth, BlockKind::kVelocity),
      0.1);
}

}  // namespace
}  // namespace hindsight
