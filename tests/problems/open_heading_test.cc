#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/true_states.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "problems/rest_by_estimate.h"
#include "simulation/scenario.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

constexpr const char* kEvery[] = {"ekf", "rts", "two_filter", "iterated",
                                  "batch"};

/// Positions that are better than the accelerometer carries them, no
/// magnetometer, and gyros that do not find north.
Scenario Watched(double accel_density, double rate_hz, double sigma) {
  Scenario s;
  s.start = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  s.start_heading = 20.0 * kDegree;
  s.imu_rate_hz = 100.0;
  s.truth_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 0.3 * kDegree / 60.0;
  s.imu.noise.accel_noise_density = accel_density;
  s.imu.gyro_bias_sigma.setConstant(500.0 * kDegree / 3600.0);
  s.imu.accel_bias_sigma.setConstant(0.02);
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.rate_hz = rate_hz;
  gnss.sigma.emplace().setConstant(sigma);
  s.aiding = {gnss};
  s.stationary.enabled = true;
  return s;
}

/// Up 20 m and down again, twice, without a turn.
std::vector<ProfilePoint> Lift() {
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= 3000; ++i) {
    ProfilePoint point;
    point.t = 0.1 * i;
    point.position = {48.0 * kDegree, 11.5 * kDegree, 500.0};
    point.v_n.z() = -1.5 * std::sin(2.0 * kPi * point.t / 75.0);
    point.euler.z() = 20.0 * kDegree;
    points.push_back(point);
  }
  return points;
}

int Seeds(int usual) {
  return testing::kSanitized ? 1 : testing::SeedCount(usual, 40);
}

class OpenHeading : public ::testing::Test {
 protected:
  /// No method is usable; those that end linearised about their own result say
  /// how unknown the heading is.
  static void ExpectOpen(const Dataset& dataset) {
    Reconstruction reconstruction(dataset, {});
    for (const std::string method : kEvery) {
      const Solution solution = reconstruction.Run(method);
      SCOPED_TRACE(::testing::Message() << method << ": " << solution.verdict);
      EXPECT_FALSE(solution.usable());
      if (method != "batch" || !solution.converged) continue;
      const int a = solution.layout.Find(BlockKind::kAttitude)->offset;
      const std::vector<State> truth =
          TrueStates(dataset, solution.layout, solution.states);
      for (std::size_t k = 0; k < truth.size(); k += 50) {
        const ErrorVector e =
            Local(solution.layout, solution.states[k], truth[k]);
        const ErrorVector P = solution.covariances.Get(k).diagonal();
        ASSERT_GT(std::sqrt(P(a + 2)), 20.0 * kDegree) << k;
        ASSERT_LT(std::abs(e(a + 2)), 4.0 * std::sqrt(P(a + 2))) << k;
      }
    }
  }
};

TEST_F(OpenHeading, StaysSoWhereAVehicleOnlyStands) {
  Scenario scenario = Watched(0.2 / 60.0, 1.0, 0.02);
  scenario.segments = {Segment::Stop(600.0)};
  const PerfectRecording recording(scenario);
  for (int seed = 0; seed < Seeds(2); ++seed) {
    Dataset dataset =
        recording.Realize(static_cast<std::uint64_t>(71000 + seed));
    SCOPED_TRACE(::testing::Message() << "seed " << 71000 + seed);
    ExpectOpen(dataset);
    AddDecidedRest(dataset.imu.t_begin(), dataset.imu.t_end(), &dataset);
    ExpectOpen(dataset);
  }
}

TEST_F(OpenHeading, StaysSoWhereAVehicleOnlyRises) {
  Scenario scenario = Watched(0.05 / 60.0, 10.0, 0.005);
  scenario.profile = Lift();
  const PerfectRecording recording(scenario);
  for (int seed = 0; seed < Seeds(1); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << 72000 + seed);
    ExpectOpen(recording.Realize(static_cast<std::uint64_t>(72000 + seed)));
  }
}

/// A constraint of side and down speed fits forward and backward alike.
TEST_F(OpenHeading, MayBeTurnedRoundWhereNothingTellsForwardFromBackward) {
  Scenario scenario = Watched(0.1 / 60.0, 1.0, 0.5);
  scenario.start_speed = 2.5;
  scenario.segments = {Segment::Straight(60.0)};
  const PerfectRecording recording(scenario);
  double wrong = 0.0;
  double told = 0.0;
  double variance = 0.0;
  for (int seed = 0; seed < testing::SeedCount(4, 40); ++seed) {
    Dataset dataset =
        recording.Realize(static_cast<std::uint64_t>(74000 + seed));
    dataset.initial.alignment = AlignmentKind::kVelocity;
    AidingStream wheels;
    wheels.sensor.name = "wheels";
    wheels.sensor.kind = &NonHolonomicKind();
    const int index = static_cast<int>(dataset.streams.size());
    for (int i = 0; i < 600; ++i) {
      Odometer straight{.form = Odometer::Form::kNonHolonomic};
      straight.sigma.setConstant(0.05);
      wheels.measurements.push_back({0.1 * i, index, false, straight});
    }
    dataset.streams.push_back(std::move(wheels));
    const Solution solution = Solve(dataset, {});
    SCOPED_TRACE(::testing::Message()
                 << 74000 + seed << " " << solution.verdict);
    EXPECT_NE(solution.grade, Grade::kUsable);
    ASSERT_FALSE(solution.rivals.empty());
    const RivalSolution& round = solution.rivals.back();
    EXPECT_EQ(round.description, "heading turned by 180 deg");
    const int h = solution.layout.Find(BlockKind::kAttitude)->offset + 2;
    const double error =
        Local(solution.layout, solution.states[0],
              TrueStates(dataset, solution.layout, solution.states)[0])(h);
    if (std::abs(error) > 0.5 * kPi) wrong += 1.0;
    told += round.probability;
    variance += round.probability * (1.0 - round.probability);
  }
  EXPECT_NEAR(wrong, told, 3.0 * std::sqrt(variance));
}

/// Where motion tells it, noise is a small part of what is known of it.
TEST_F(OpenHeading, IsAsSureAsItSaysWhereAVehicleMoves) {
  Scenario scenario = Watched(3.0 / 60.0, 1.0, 0.05);
  scenario.segments = {Segment::Stop(20.0)};
  for (int i = 0; i < 6; ++i) {
    scenario.segments.push_back(Segment::Accelerate(3.0, 0.5));
    scenario.segments.push_back(Segment::Turn(90.0 * kDegree, 0.2));
    scenario.segments.push_back(Segment::Stop(5.0, 0.5));
  }
  const PerfectRecording recording(scenario);
  const int seeds = testing::SeedCount(6, 60);
  double nees = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Dataset dataset =
        recording.Realize(static_cast<std::uint64_t>(73000 + seed));
    const Solution solution = Solve(dataset, {});
    EXPECT_TRUE(solution.usable()) << 73000 + seed << " " << solution.verdict;
    const int h = solution.layout.Find(BlockKind::kAttitude)->offset + 2;
    const std::size_t k = solution.states.size() / 2;
    const double e =
        Local(solution.layout, solution.states[k],
              TrueStates(dataset, solution.layout, solution.states)[k])(h);
    const double P = solution.covariances.Get(k)(h, h);
    EXPECT_LT(std::sqrt(P), 10.0 * kDegree) << 73000 + seed;
    EXPECT_TRUE(solution.rivals.empty()) << 73000 + seed;
    nees += e * e / P;
  }
  const Interval bounds = AneesBounds(seeds, 1, 0.998);
  EXPECT_TRUE(bounds.Contains(nees / seeds)) << nees / seeds;
}

}  // namespace
}  // namespace hindsight
