#include "simulation/motion_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

std::vector<Segment> Aerobatics() {
  return {Segment::Straight(2.0),
          Segment::Pitch(10.0 * kDegree, 3.0 * kDegree),
          Segment::BankedTurn(-120.0 * kDegree, 6.0 * kDegree),
          Segment::Accelerate(95.0, 1.5),
          Segment::BankedTurn(3.0 * kDegree, 6.0 * kDegree),
          Segment::Pitch(-25.0 * kDegree, 5.0 * kDegree),
          Segment::Straight(3.0)};
}

TEST(MotionProfile, RatesAreTheDerivativesOfTheMotion) {
  const MotionProfile profile(Aerobatics(), 80.0, 0.3);
  const double h = 1e-5;
  // Third derivatives of the ramps are below 20 per blend^2.
  const double tolerance = 1e-7;
  for (double t = 0.037; t < profile.duration(); t += 0.171) {
    const BodyMotion a = profile.At(t - h);
    const BodyMotion m = profile.At(t);
    const BodyMotion b = profile.At(t + h);
    EXPECT_NEAR((b.speed - a.speed) / (2 * h), m.speed_rate, tolerance) << t;
    EXPECT_NEAR((b.roll - a.roll) / (2 * h), m.roll_rate, tolerance) << t;
    EXPECT_NEAR((b.pitch - a.pitch) / (2 * h), m.pitch_rate, tolerance) << t;
    EXPECT_NEAR((b.heading - a.heading) / (2 * h), m.heading_rate, tolerance)
        << t;
    EXPECT_LT(
        ((b.Velocity() - a.Velocity()) / (2 * h) - m.Acceleration()).norm(),
        1e-6)
        << t;
    const Eigen::Vector3d turn = Log(a.Attitude().conjugate() * b.Attitude());
    EXPECT_LT((turn / (2 * h) - m.BodyRate()).norm(), tolerance) << t;
  }
}

TEST(MotionProfile, RatesAreContinuousWithABlend) {
  const MotionProfile profile(Aerobatics(), 80.0, 0.0);
  for (const double knot : profile.knots()) {
    const BodyMotion a = profile.At(std::max(0.0, knot - 1e-9));
    const BodyMotion b = profile.At(knot + 1e-9);
    EXPECT_LT((a.BodyRate() - b.BodyRate()).norm(), 1e-7) << knot;
    EXPECT_LT((a.Acceleration() - b.Acceleration()).norm(), 1e-6) << knot;
  }
}

TEST(MotionProfile, TurnReachesItsRateAndItsAngle) {
  const MotionProfile profile({Segment::Turn(90.0 * kDegree, 45.0 * kDegree)},
                              5.0, 0.0);
  // 2 s at the full rate and half a second lost at each blend.
  EXPECT_NEAR(profile.duration(), 3.0, 1e-12);
  EXPECT_NEAR(profile.At(1.5).heading_rate, 45.0 * kDegree, 1e-12);
  EXPECT_NEAR(profile.At(1.5).heading, 45.0 * kDegree, 1e-12);
  EXPECT_NEAR(profile.At(1.0).heading, 22.5 * kDegree, 1e-12);
  EXPECT_NEAR(profile.At(4.0).heading, 90.0 * kDegree, 1e-12);
  EXPECT_EQ(profile.At(4.0).heading_rate, 0.0);
}

TEST(MotionProfile, WithoutBlendTheRateSteps) {
  Segment corner = Segment::Turn(90.0 * kDegree, 45.0 * kDegree);
  corner.blend = 0.0;
  const MotionProfile profile({Segment::Straight(1.0), corner}, 5.0, 0.0);
  EXPECT_NEAR(profile.duration(), 3.0, 1e-12);
  EXPECT_EQ(profile.At(1.0 - 1e-9).heading_rate, 0.0);
  EXPECT_EQ(profile.At(1.0 + 1e-9).heading_rate, 45.0 * kDegree);
  EXPECT_NEAR(profile.At(2.0).heading, 45.0 * kDegree, 1e-12);
}

TEST(MotionProfile, SmallChangeBlendsFasterAndKeepsItsRate) {
  const MotionProfile profile({Segment::Turn(2.0 * kDegree, 10.0 * kDegree)},
                              5.0, 0.0);
  EXPECT_NEAR(profile.duration(), 0.4, 1e-12);
  EXPECT_NEAR(profile.At(0.2).heading_rate, 10.0 * kDegree, 1e-12);
  EXPECT_NEAR(profile.At(0.4).heading, 2.0 * kDegree, 1e-12);
}

TEST(MotionProfile, BankedTurnHasNoLateralSpecificForce) {
  const MotionProfile profile(
      {Segment::BankedTurn(180.0 * kDegree, 5.0 * kDegree)}, 100.0, 0.0);
  const Eigen::Vector3d gravity(0.0, 0.0, kStandardGravity);
  for (double t = 0.25; t < profile.duration(); t += 0.5) {
    const BodyMotion m = profile.At(t);
    const Eigen::Vector3d f_b =
        m.Attitude().conjugate() * (m.Acceleration() - gravity);
    EXPECT_NEAR(f_b.y(), 0.0, 1e-12) << t;
    EXPECT_GT(m.roll, 0.0) << t;
  }
  EXPECT_NEAR(profile.At(18.0).roll,
              std::atan(100.0 * 5.0 * kDegree / kStandardGravity), 1e-12);
}

TEST(MotionProfile, StopBrakesAndStands) {
  const MotionProfile profile({Segment::Stop(7.0, 2.0)}, 10.0, 1.0);
  EXPECT_NEAR(profile.duration(), 10.0 / 2.0 + 1.0 + 7.0, 1e-12);
  EXPECT_EQ(profile.At(6.0).speed, 0.0);
  EXPECT_EQ(profile.At(12.9).speed, 0.0);
  EXPECT_NEAR(profile.At(3.0).speed_rate, -2.0, 1e-12);
}

TEST(MotionProfile, RefusesWhatCannotBeDrivenAndNamesTheSegment) {
  const auto message = [](const std::vector<Segment>& segments) -> std::string {
    try {
      MotionProfile(segments, 10.0, 0.0);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const Segment good = Segment::Straight(1.0);
  EXPECT_EQ(message({good}), "accepted");
  EXPECT_THAT(message({}), ::testing::HasSubstr("empty"));
  EXPECT_THAT(message({good, Segment::Straight(0.0)}),
              ::testing::HasSubstr("segment 2: the duration"));
  EXPECT_THAT(message({Segment::Turn(1.0, -0.1)}),
              ::testing::HasSubstr("segment 1: the rate"));
  EXPECT_THAT(message({Segment::Turn(1.0, std::nan(""))}),
              ::testing::HasSubstr("segment 1: the rate"));
  EXPECT_THAT(message({Segment::Accelerate(-1.0, 1.0)}),
              ::testing::HasSubstr("speed to reach"));
  EXPECT_THAT(message({Segment::Pitch(1.6, 0.1)}),
              ::testing::HasSubstr("85 deg"));
  Segment banked = Segment::BankedTurn(1.0, 0.1);
  banked.blend = 0.0;
  EXPECT_THAT(message({banked}), ::testing::HasSubstr("banked"));
}

TEST(WanderingDrive, StaysWithinItsLimits) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const MotionProfile profile(WanderingDrive(900.0, seed), 0.0, 0.0);
    EXPECT_GE(profile.duration(), 900.0);
    double fastest = 0.0;
    double standing = 0.0;
    for (double t = 0.0; t < profile.duration(); t += 0.1) {
      const BodyMotion m = profile.At(t);
      fastest = std::max(fastest, m.speed);
      standing += m.speed == 0.0 ? 0.1 : 0.0;
      EXPECT_LT(std::abs(m.speed * m.heading_rate), 3.0);
    }
    EXPECT_LE(fastest, 20.0);
    EXPECT_GT(fastest, 12.0);
    EXPECT_GT(standing, 5.0);
  }
}

}  // namespace
}  // namespace hindsight
