#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "support/in_flight.h"

namespace hindsight {
namespace {

TEST(InFlightAlignment, FliesStraightThenTurnsEachWayEveryHalfMinute) {
  const auto trajectory = MakeTrajectory(InFlightAlignment());
  EXPECT_NEAR(trajectory->t_end(), 150.0, 1e-9);
  const auto euler = [&](double t) {
    const Motion m = trajectory->At(t);
    return EulerFromQuaternion(Eigen::Quaterniond(NedAxes(m.p_e).transpose()) *
                               m.q_eb);
  };
  EXPECT_NEAR(euler(9.9).x(), 0.0, 1e-9);
  EXPECT_NEAR(euler(9.9).z(), euler(0.0).z(), 1e-3);
  double side = 1.0;
  for (const double middle : {20.0, 50.0, 80.0, 110.0, 140.0}) {
    EXPECT_NEAR(euler(middle).x(), side * 35.0 * kDegree, 1e-6) << middle;
    side = -side;
  }
  for (const double between : {35.0, 65.0, 95.0, 125.0}) {
    EXPECT_NEAR(euler(between).x(), 0.0, 1e-9) << between;
  }
  const double speeds[] = {150.0, 165.0, 145.0, 165.0, 150.0};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(trajectory->At(20.0 + 30.0 * i).v_e.norm(), speeds[i], 1e-6);
  }
}

TEST(InFlightAlignment, GivesThePositionAloneAndTheRateAskedFor) {
  const Dataset data = Simulate(InFlightAlignment(1.0), 3);
  EXPECT_TRUE(data.initial.position);
  EXPECT_FALSE(data.initial.v_n);
  EXPECT_FALSE(data.initial.euler);
  EXPECT_EQ(data.streams[0].measurements.size(), 151u);
  EXPECT_THROW(InFlightAlignment(0.0), InputError);
}

TEST(InFlightAlignment, HasTruthAtEveryVelocity) {
  for (const double rate : {10.0, 5.0, 2.0, 1.0}) {
    const Dataset data = Simulate(InFlightAlignment(rate), 1);
    std::size_t k = 0;
    for (const Measurement& z : data.streams[0].measurements) {
      while (k + 1 < data.truth.size() && data.truth[k].t < z.t - 1e-6) ++k;
      ASSERT_NEAR(data.truth[k].t, z.t, 1e-6) << rate << " Hz";
    }
  }
}

TEST(InFlightAlignment, ABadStartHasItsSizeInAnyDirection) {
  Dataset data = Simulate(InFlightAlignment(), 1);
  const BadStart start{30.0 * kDegree, 120.0 * kDegree};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    GiveBadStart(start, seed, &data);
    const Eigen::Vector3d euler = *data.initial.euler;
    // psi = tilt after heading: the vertical is off by the tilt alone.
    const Eigen::Quaterniond error =
        *data.truth.front().q_nb *
        QuaternionFromEuler(euler.x(), euler.y(), euler.z()).conjugate();
    const Eigen::Vector3d down = error * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(std::acos(down.z()), start.tilt, 1e-9);
    const Eigen::Quaterniond twist =
        Eigen::Quaterniond(error.w(), 0.0, 0.0, error.z()).normalized();
    EXPECT_NEAR(std::abs(Log(twist).z()), start.heading, 1e-9);
    mean += Log(error) / kSeeds;
  }
  EXPECT_LT(mean.norm(), 0.5);
}

}  // namespace
}  // namespace hindsight
