#include <gtest/gtest.h>

#include "alignment/ahrs.h"
#include "attitude/attitude_filter.h"
#include "base/chi_square.h"
#include "geometry/so3.h"
#include "simulation/vibration_attitude.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// A body that turns at 50 deg/s from the first sample on: neither rest nor
/// velocity.
AlignmentOutcome AlignTurningBody(const Dataset& dataset, double to) {
  AlignmentInput input{dataset};
  input.to = to;
  input.p_e = AttitudePlace().p_e;
  return AlignByAhrs(input);
}

Dataset TurningBody(std::uint64_t seed) {
  VibrationAttitudeOptions options;
  options.acceleration = 0.0;
  return SimulateVibrationAttitude(options, seed);
}

TEST(AhrsAlignment, FindsAttitudeAndBiasOfATurningBody) {
  constexpr int kRuns = testing::SeedCount(20);
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Dataset dataset = TurningBody(seed);
    const AlignmentOutcome outcome = AlignTurningBody(dataset, 60.0);
    ASSERT_TRUE(outcome.found.has_value()) << outcome.reason;
    const AlignedAttitude& found = *outcome.found;
    const Eigen::Vector3d psi =
        Log(*dataset.truth.front().q_nb * found.q_nb.conjugate());
    nees += psi.dot(found.P.llt().solve(psi)) / kRuns;
    EXPECT_LT(psi.norm(), 1.0 * kDegree) << seed;
    const Eigen::Vector3d bias = *dataset.truth.front().b_g -
                                 found.b_g.value_or(Eigen::Vector3d::Zero());
    EXPECT_LT(bias.cwiseQuotient(found.b_g_sigma).cwiseAbs().maxCoeff(), 4.5);
    EXPECT_GT(found.reuse, 1.0);
  }
  EXPECT_TRUE(AneesBounds(kRuns, 3, 0.999).Contains(nees)) << nees;
}

TEST(AhrsAlignment, IsNoSurerThanTheFieldIsKnown) {
  Dataset dataset = TurningBody(1);
  ASSERT_EQ(dataset.streams.size(), 1u);
  MagneticSurroundings& magnetic = dataset.streams[0].sensor.magnetic;
  magnetic.disturbance_sigma = 0.1 * magnetic.horizontal;
  const AlignmentOutcome outcome = AlignTurningBody(dataset, 60.0);
  ASSERT_TRUE(outcome.found.has_value());
  EXPECT_GT(outcome.found->P(2, 2), 0.1 * 0.1);
  EXPECT_LT(outcome.found->P(2, 2), 0.12 * 0.12);
  EXPECT_LT(outcome.found->P(0, 0), 0.01 * 0.01);
}

TEST(AhrsAlignment, LeavesTheHeadingOpenWithoutAMagnetometer) {
  Dataset dataset = TurningBody(1);
  dataset.streams.clear();
  const AlignmentOutcome outcome = AlignTurningBody(dataset, 60.0);
  ASSERT_TRUE(outcome.found.has_value());
  EXPECT_GT(outcome.found->P(2, 2), 1.0);
  EXPECT_LT(outcome.found->P(0, 0), 0.01);
}

TEST(AhrsAlignment, NeedsFiveSeconds) {
  EXPECT_FALSE(AlignTurningBody(TurningBody(1), 4.0).found.has_value());
}

}  // namespace
}  // namespace hindsight
