#include "simulation/hand_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

const Geodetic kRoom = {0.8, 0.2, 500.0};

TEST(HandTrajectory, VelocityAccelerationAndRateAreDerivatives) {
  HandTrajectory trajectory(kRoom, 0.7, {100.0, 3});
  const double h = 1e-3;
  for (double t = 9.5; t < 91.0; t += 0.373) {
    const Motion a = trajectory.At(t - h);
    const Motion m = trajectory.At(t);
    const Motion b = trajectory.At(t + h);
    // Positions of 6.4e6 m are rounded to 1e-9 m; the differences have h^2/6 of
    // a third derivative, up to 1000 rad/s^3.
    EXPECT_LT(((b.p_e - a.p_e) / (2 * h) - m.v_e).norm(), 1e-4) << t;
    EXPECT_LT(((b.v_e - a.v_e) / (2 * h) - m.a_e).norm(), 1e-4) << t;
    const Eigen::Vector3d turn = Log(a.q_eb.conjugate() * b.q_eb);
    EXPECT_LT((turn / (2 * h) - m.w_eb_b).norm(), 2e-4) << t;
  }
}

TEST(HandTrajectory, RestsAtBothEnds) {
  HandTrajectory trajectory(kRoom, 0.7, {60.0, 4});
  const Motion start = trajectory.At(0.0);
  for (const double t : {0.0, 5.0, 10.0, 50.0, 55.0, 60.0}) {
    const Motion m = trajectory.At(t);
    EXPECT_EQ(m.v_e.norm(), 0.0) << t;
    EXPECT_EQ(m.w_eb_b.norm(), 0.0) << t;
    EXPECT_EQ((m.p_e - start.p_e).norm(), 0.0) << t;
    EXPECT_LT(m.q_eb.angularDistance(start.q_eb), 1e-12) << t;
  }
  EXPECT_GT(trajectory.At(30.0).w_eb_b.norm(), 0.0);
}

/// Root mean squares of the rate and the acceleration of an axis.
TEST(HandTrajectory, IsAsQuickAsAHand) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HandTrajectory trajectory(kRoom, 0.0, {180.0, seed});
    double rate = 0.0, acceleration = 0.0;
    int count = 0;
    for (double t = 13.0; t < 167.0; t += 0.05) {
      const Motion m = trajectory.At(t);
      rate += m.w_eb_b.squaredNorm() / 3.0;
      acceleration += m.a_e.squaredNorm() / 3.0;
      ++count;
    }
    EXPECT_GT(std::sqrt(rate / count), 0.8) << seed;
    EXPECT_LT(std::sqrt(rate / count), 2.5) << seed;
    EXPECT_GT(std::sqrt(acceleration / count), 1.0) << seed;
    EXPECT_LT(std::sqrt(acceleration / count), 3.0) << seed;
  }
}

TEST(HandTrajectory, IsAnotherOneForAnotherSeed) {
  HandTrajectory a(kRoom, 0.0, {60.0, 1}), b(kRoom, 0.0, {60.0, 2}),
      again(kRoom, 0.0, {60.0, 1});
  EXPECT_GT((a.At(30.0).p_e - b.At(30.0).p_e).norm(), 0.01);
  EXPECT_EQ((a.At(30.0).p_e - again.At(30.0).p_e).norm(), 0.0);
}

}  // namespace
}  // namespace hindsight
