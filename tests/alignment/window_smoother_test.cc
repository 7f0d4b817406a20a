#include "alignment/window_smoother.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/coarse_alignment.h"
#include "dataset/ground_motion.h"
#include "earth/wgs84.h"
#include "support/in_flight.h"

namespace hindsight {
namespace {

constexpr double kEnd = 30.0;

AlignmentInput InputOf(const Dataset& dataset) {
  AlignmentInput input{.dataset = dataset, .t = 0.0, .to = kEnd};
  input.p_e = EcefFromGeodetic(*dataset.initial.position);
  input.velocities = GroundVelocities(dataset, 0.0, kEnd);
  input.gyro_sigma = dataset.initial.gyro_bias_sigma->maxCoeff();
  return input;
}

WindowStart Coarse(const AlignmentInput& input) {
  const auto coarse = AlignCoarsely(input, kEnd, input.b_g, input.b_a);
  return {coarse->q_eb, coarse->b_g, coarse->b_a, coarse->P};
}

TEST(WindowSmoother, WhatOneWalkFoundLeadsTheNextToTheSame) {
  const PerfectRecording recording(InFlightAlignment());
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Dataset dataset = recording.Realize(seed);
    MountAnywhere(seed, &dataset);
    dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(kDegree);
    const AlignmentInput input = InputOf(dataset);
    const WindowStart start = Coarse(input);
    const double slow = dataset.imu.noise.gyro_bias_walk;
    const double fast = 0.1 * kDegree;
    WindowSmoother one(input, kEnd);
    ASSERT_TRUE(one.Smooth(start, slow)) << seed;
    const auto led = one.Smooth(start, fast);
    const auto alone = WindowSmoother(input, kEnd).Smooth(start, fast);
    ASSERT_TRUE(led && alone) << seed;
    EXPECT_EQ(led->gyro_bias_walk, alone->gyro_bias_walk);
    EXPECT_LT(LargestMoveInSigmas(alone->layout, led->states, alone->states,
                                  alone->P),
              2.0 * kNegligibleRest)
        << seed;
    EXPECT_NEAR(led->log_likelihood, alone->log_likelihood, 0.01) << seed;
    const Eigen::VectorXd ratio =
        led->P.Get(0).diagonal().cwiseQuotient(alone->P.Get(0).diagonal());
    EXPECT_LT((ratio.array() - 1.0).abs().maxCoeff(), 0.01) << seed;
  }
}

TEST(WindowSmoother, AskedAgainAnswersTheSame) {
  const PerfectRecording recording(InFlightAlignment());
  Dataset dataset = recording.Realize(5);
  MountAnywhere(5, &dataset);
  const AlignmentInput input = InputOf(dataset);
  const WindowStart start = Coarse(input);
  WindowSmoother smoother(input, kEnd);
  const auto first = smoother.Smooth(start, 0.0);
  smoother.Smooth(start, 0.1 * kDegree);
  const auto again = smoother.Smooth(start, 0.0);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->states.front().q_eb.coeffs(),
            again->states.front().q_eb.coeffs());
  EXPECT_EQ(first->P.Get(0), again->P.Get(0));
}

}  // namespace
}  // namespace hindsight
