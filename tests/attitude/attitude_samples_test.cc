#include "attitude/attitude_samples.h"

#include <gtest/gtest.h>

#include "attitude/attitude_filter.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kStep = 0.01;
const Eigen::Vector3d kBias(0.01, -0.02, 0.03);

/// A body whose rate changes linearly about a fixed axis, so that its attitude
/// is known exactly.
Eigen::Quaterniond AttitudeAt(double t) {
  return Exp((0.5 * t + 0.2 * t * t) * Eigen::Vector3d(0.6, 0.0, 0.8));
}

ImuStream Stream() {
  ImuStream imu;
  for (int k = 0; k <= 200; ++k) {
    const double t = k * kStep;
    imu.samples.push_back(
        {t, (0.5 + 0.4 * t) * Eigen::Vector3d(0.6, 0.0, 0.8) + kBias,
         Eigen::Vector3d::Zero()});
  }
  return imu;
}

/// Nodes on and off the samples, turned about down by `error` [rad] a node.
Solution Nodes(const ImuStream& imu, double error) {
  Solution nodes;
  nodes.layout = AttitudeLayout(imu.noise, AttitudeState());
  const std::vector<double> times = {0.0, 0.1, 0.337, 0.34, 1.2345, 2.0};
  nodes.covariances = CovarianceSeries(6, times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    State x;
    x.t = times[k];
    x.q_eb = AttitudeAt(x.t) *
             Exp(error * static_cast<double>(k) * Eigen::Vector3d::UnitZ());
    x.b_g = kBias;
    nodes.states.push_back(x);
    nodes.covariances.Set(k, static_cast<double>(k + 1) *
                                 Eigen::Matrix<double, 6, 6>::Identity());
  }
  return nodes;
}

TEST(NodesAtSamples, FollowsTheGyrosFromNodeToNode) {
  const ImuStream imu = Stream();
  const Solution nodes = Nodes(imu, 0.0);
  const Solution samples = NodesAtSamples(nodes, imu, nodes.layout);
  ASSERT_EQ(samples.states.size(), imu.samples.size());
  for (const State& x : samples.states) {
    EXPECT_LT(x.q_eb.angularDistance(AttitudeAt(x.t)), 1e-9) << x.t;
  }
}

TEST(NodesAtSamples, MeetsEveryNodeWhateverTheGyrosMiss) {
  const ImuStream imu = Stream();
  const double error = 0.01;
  const Solution nodes = Nodes(imu, error);
  const Solution samples = NodesAtSamples(nodes, imu, nodes.layout);
  ASSERT_EQ(samples.states.size(), imu.samples.size());
  for (const std::size_t node : {0u, 1u, 3u, 5u}) {
    const State& x = nodes.states[node];
    const auto k = static_cast<std::size_t>(std::lround(x.t / kStep));
    EXPECT_LT(samples.states[k].q_eb.angularDistance(x.q_eb), 1e-9) << x.t;
  }
  // Half-way between nodes 0 and 1 half of the difference has been made good.
  EXPECT_NEAR(samples.states[5].q_eb.angularDistance(AttitudeAt(0.05)),
              0.5 * error, 1e-4);
  EXPECT_EQ(samples.covariances.Get(4)(0, 0), 1.0);
  EXPECT_EQ(samples.covariances.Get(6)(0, 0), 2.0);
}

TEST(SampleAttitude, KnowsNothingOfTheNextState) {
  const ImuStream imu = Stream();
  Solution solution =
      NodesAtSamples(Nodes(imu, 0.0), imu, Nodes(imu, 0.0).layout);
  const Solution before = SampleAttitude(solution, imu, {0.505});
  solution.states[51].q_eb = Eigen::Quaterniond::Identity();
  const Solution after = SampleAttitude(solution, imu, {0.505});
  EXPECT_LT(before.states[0].q_eb.angularDistance(AttitudeAt(0.505)), 1e-4);
  EXPECT_EQ(before.states[0].q_eb.coeffs(), after.states[0].q_eb.coeffs());
}

}  // namespace
}  // namespace hindsight
