#include "attitude/attitude_samples.h"

#include <gtest/gtest.h>

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

TEST(SampleAttitude, KnowsNothingOfTheNextState) {
  const ImuStream imu = Stream();
  Solution solution;
  for (const ImuSample& sample : imu.samples) {
    State x;
    x.t = sample.t;
    x.q_eb = AttitudeAt(x.t);
    x.b_g = kBias;
    solution.states.push_back(x);
  }
  const Solution before = SampleAttitude(solution, imu, {0.505});
  solution.states[51].q_eb = Eigen::Quaterniond::Identity();
  const Solution after = SampleAttitude(solution, imu, {0.505});
  EXPECT_LT(before.states[0].q_eb.angularDistance(AttitudeAt(0.505)), 1e-4);
  EXPECT_EQ(before.states[0].q_eb.coeffs(), after.states[0].q_eb.coeffs());
}

}  // namespace
}  // namespace hindsight
