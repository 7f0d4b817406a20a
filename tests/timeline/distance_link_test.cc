#include "timeline/distance_link.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "measurements/numeric_jacobian.h"
#include "timeline/time_update.h"

namespace hindsight {
namespace {

using testing::RichScene;
using testing::Scene;

/// Two nodes 0.2 s apart in lively motion, with every block that the link
/// depends on.
struct Pair {
  explicit Pair(bool starts) : imu(testing::LivelyImu(10.0, 50.0)) {
    const Scene scene = RichScene();
    layout = scene.layout;
    Block block;
    block.key = {BlockKind::kDistance, 0};
    block.name = "distance";
    block.evolution = Evolution::Navigation();
    block.sigma0.setOnes();
    layout.Add(block);
    sensor = scene.sensor;
    std::vector<Node> nodes(2);
    nodes[0].t = 4.0;
    nodes[1].t = 4.2;
    timeline.emplace(nodes, std::vector<Measurement>{},
                     std::vector<Sensor>{sensor}, imu, true);
    if (starts) timeline->SetIncrementStarts({{0, 0, 3.99, std::nullopt}});
    x_i = scene.state;
    x_i.t = 4.0;
    x_i.parameters.conservativeResize(layout.parameter_count());
    x_i.parameters(layout.Find(BlockKind::kDistance, 0)->parameter_offset) = 3;
    x_j = Advance(layout, IntervalAfter(0, layout, x_i, &*timeline), x_i);
  }
  DistanceLink Evaluate(const State& i, const State& j) const {
    return EvaluateDistanceLink(layout, *timeline, 0, i, j, 0);
  }
  ImuStream imu;
  ErrorLayout layout;
  Sensor sensor;
  std::optional<Timeline> timeline;
  State x_i, x_j;
};

TEST(DistanceLink, JacobiansMatchNumericDifferences) {
  for (const bool starts : {false, true}) {
    const Pair pair(starts);
    const DistanceLink at = pair.Evaluate(pair.x_i, pair.x_j);
    for (int c = 0; c < pair.layout.dim(); ++c) {
      const double h = c < 3 ? 0.1 : 1e-4;
      ErrorVector step = ErrorVector::Zero(pair.layout.dim());
      step(c) = h;
      const auto moved = [&](const State& x, double sign) {
        return Retract(pair.layout, x, sign * step);
      };
      const double at_i =
          (pair.Evaluate(moved(pair.x_i, 1), pair.x_j).distance -
           pair.Evaluate(moved(pair.x_i, -1), pair.x_j).distance) /
          (2.0 * h);
      // Constants enter through i alone.
      const bool constant = c >= 9;
      const double at_j =
          constant ? 0.0
                   : (pair.Evaluate(pair.x_i, moved(pair.x_j, 1)).distance -
                      pair.Evaluate(pair.x_i, moved(pair.x_j, -1)).distance) /
                         (2.0 * h);
      EXPECT_NEAR(at.J_i(c), at_i, 3e-5)
          << pair.layout.ComponentName(c) << " at i"
          << (starts ? ", start" : "");
      EXPECT_NEAR(at.J_j(c), at_j, 3e-5)
          << pair.layout.ComponentName(c) << " at j"
          << (starts ? ", start" : "");
    }
  }
}

TEST(DistanceLink, TransitionMatchesNumericDifferenceOfThePrediction) {
  for (const bool starts : {false, true}) {
    Pair pair(starts);
    const NodeInterval interval = {*pair.timeline, 0,
                                   pair.timeline->Summary(0)};
    Transition transition;
    LinearizeAdvance(pair.layout, interval, pair.x_i, pair.x_j, &transition);
    const Block& block = *pair.layout.Find(BlockKind::kDistance, 0);
    EXPECT_NEAR(transition.c(block.offset), 0.0, 1e-9);
    const auto predicted = [&](const ErrorVector& step) {
      const State x = Retract(pair.layout, pair.x_i, step);
      const State y = Advance(pair.layout, interval, x);
      return y.parameters(block.parameter_offset);
    };
    for (int c = 0; c < pair.layout.dim(); ++c) {
      const double h = c < 3 ? 0.1 : 1e-4;
      ErrorVector step = ErrorVector::Zero(pair.layout.dim());
      step(c) = h;
      const double numeric = (predicted(step) - predicted(-step)) / (2.0 * h);
      EXPECT_NEAR(transition.Phi(block.offset, c), numeric, 3e-5)
          << pair.layout.ComponentName(c);
    }
    // The variance of the row is that of J_j w: symmetric and regular.
    EXPECT_LT((transition.Q - transition.Q.transpose()).norm(), 1e-15);
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(transition.Q)
                  .eigenvalues()
                  .minCoeff(),
              -1e-15);
  }
}

TEST(DistanceLink, IsTheArcOfASteadyTurnWhateverItsAngle) {
  // 10 m/s and 0.8 rad/s about the vertical through 2.4 rad: chord 23.3 m,
  // arc 30 m.
  const double speed = 10.0, rate = 0.8, dt = 3.0;
  ErrorLayout layout = testing::TypicalLayout();
  Block block;
  block.key = {BlockKind::kDistance, 0};
  block.name = "distance";
  block.evolution = Evolution::Navigation();
  layout.Add(block);
  const ImuStream imu = testing::LivelyImu(10.0, 50.0);
  std::vector<Node> nodes(2);
  nodes[1].t = dt;
  const Timeline timeline(nodes, {}, {Sensor()}, imu, false);
  const auto at = [&](double t) {
    State x = testing::TypicalState();
    const Eigen::Matrix3d C = x.q_eb.toRotationMatrix();
    const double a = rate * t;
    x.p_e += C * Eigen::Vector3d(speed / rate * std::sin(a),
                                 speed / rate * (1.0 - std::cos(a)), 0.0);
    x.q_eb = x.q_eb * Exp(Eigen::Vector3d(0.0, 0.0, a));
    x.parameters.setZero(layout.parameter_count());
    return x;
  };
  const DistanceLink link =
      EvaluateDistanceLink(layout, timeline, 0, at(0.0), at(dt), 0);
  EXPECT_NEAR(link.distance, speed * dt, 1e-8);
}

TEST(DistanceLink, IncrementMatchesNumericDifference) {
  Scene scene = RichScene();
  Block block;
  block.key = {BlockKind::kDistance, 0};
  block.name = "distance";
  block.sigma0.setOnes();
  scene.layout.Add(block);
  scene.state.parameters.conservativeResize(scene.layout.parameter_count());
  scene.state.parameters.tail<1>()(0) = 1.2;
  Odometer odometer;
  odometer.form = Odometer::Form::kIncrements;
  odometer.distance = 2.0;
  odometer.sigma = {0.01, 1.0, 1.0};
  const Measurement z{0.0, 0, false, odometer};
  EXPECT_EQ(Rows(z), 1);
  testing::ExpectJacobian(scene, z, "increment");
}

}  // namespace
}  // namespace hindsight
