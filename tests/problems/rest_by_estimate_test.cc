#include "problems/rest_by_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alignment/start.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "evaluation/trajectory_error.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

Scenario LoadCorners(const char* name) {
  return LoadScenario(std::string(HINDSIGHT_SOURCE_DIR) + "/data/scenarios/" +
                      name + ".yaml");
}

/// The last tenths of a second of braking, which ends without a jolt, are
/// slower than a quiet window can tell.
bool Stands(const TruthPoint& point) { return point.v_n->norm() < 0.05; }

/// Seconds of the truth inside the spans, and how many of these stand.
struct Seconds {
  double all = 0.0;
  double standing = 0.0;
  double moving() const { return all - standing; }
};

Seconds Count(const std::vector<TimeInterval>& spans, const Dataset& dataset) {
  Seconds seconds;
  const double step = dataset.truth[1].t - dataset.truth[0].t;
  for (const TruthPoint& point : dataset.truth) {
    const bool inside = std::any_of(
        spans.begin(), spans.end(), [&point](const TimeInterval& span) {
          return point.t >= span.begin && point.t <= span.end;
        });
    if (!inside) continue;
    seconds.all += step;
    if (Stands(point)) seconds.standing += step;
  }
  return seconds;
}

TrajectoryStatistics Errors(const Dataset& dataset) {
  return SummarizeErrors(
      ComputeTrajectoryErrors(TableFromSolution(Solve(dataset, {})),
                              dataset.truth, {}),
      dataset.truth.size());
}

/// With what rest says, and without.
struct Compared {
  TrajectoryStatistics with;
  TrajectoryStatistics without;
};

Compared Compare(Dataset dataset) {
  Compared compared;
  compared.without = Errors(dataset);
  AddDecidedRest(dataset.imu.t_begin(), dataset.imu.t_end(), &dataset);
  compared.with = Errors(dataset);
  return compared;
}

TEST(DecideRest, ADriveThatBeginsInMotionIsNotSaidToStand) {
  Scenario scenario = LoadCorners("corners_moving");
  double nees = 0.0;
  int runs = 0;
  for (const double first_fix : {2.0, 5.0, 10.0, 20.0}) {
    scenario.aiding[0].from = first_fix;
    const PerfectRecording recording(scenario);
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      Dataset dataset = recording.Realize(seed);
      EXPECT_TRUE(DecideRest(&dataset).at_rest.empty());
      const Compared compared = Compare(std::move(dataset));
      EXPECT_NEAR(compared.with.position->horizontal.rms,
                  compared.without.position->horizontal.rms,
                  0.05 * compared.without.position->horizontal.rms)
          << first_fix << " " << seed;
      // One fix a second, half a metre each: the second integral of 20 s of IMU
      // adds to it what the velocity is not known to.
      EXPECT_LT(compared.with.position->horizontal.rms,
                first_fix < 20.0 ? 0.6 : 1.2)
          << first_fix << " " << seed;
      nees += *compared.with.position_nees;
      ++runs;
    }
  }
  // Errors of a run are alike throughout: at worst one point of three degrees
  // of freedom a run. Chi-square of 36, 99.9 % two-sided, over 12.
  EXPECT_GT(nees / runs, 12.6 / 12.0);
  EXPECT_LT(nees / runs, 72.2 / 12.0);
}

TEST(DecideRest, SlowMotionIsNotSurelyTakenForRest) {
  // Horizontal position errors beyond five of their sigmas are hardly any.
  Scenario scenario = LoadCorners("corners_moving");
  scenario.imu.gyro_bias_sigma.setConstant(300.0 * kDegree / 3600.0);
  scenario.imu.accel_bias_sigma.setConstant(0.01 * kStandardGravity);
  for (const double speed : {0.05, 0.3}) {
    scenario.start_speed = speed;
    const PerfectRecording recording(scenario);
    for (const std::uint64_t seed : {101u, 102u}) {
      Dataset dataset = recording.Realize(seed);
      AddDecidedRest(dataset.imu.t_begin(), dataset.imu.t_end(), &dataset);
      const TrajectoryStatistics errors = Errors(dataset);
      EXPECT_LT(errors.position->horizontal.rms, 0.6) << speed << " " << seed;
      EXPECT_LT(*errors.position_nees, 15.0) << speed << " " << seed;
    }
  }
}

TEST(DecideRest, WithheldFixesLeaveTheResultAsItIs) {
  Scenario scenario = LoadCorners("corners_moving");
  scenario.withholdings = {
      {.sensor = "gnss", .every = 20.0, .length = 12.0, .from = std::nullopt}};
  const PerfectRecording recording(scenario);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Compared compared = Compare(recording.Realize(seed));
    EXPECT_NEAR(compared.with.position->horizontal.rms,
                compared.without.position->horizontal.rms,
                0.05 * compared.without.position->horizontal.rms)
        << seed;
  }
}

TEST(DecideRest, RareFixesMakeNoStandstillOfMotion) {
  for (const char* name : {"corners", "corners_moving"}) {
    Scenario scenario = LoadCorners(name);
    scenario.aiding[0].rate_hz = 0.02;
    const PerfectRecording recording(scenario);
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      Dataset dataset = recording.Realize(seed);
      const Rest rest = DecideRest(&dataset);
      EXPECT_EQ(Count(rest.at_rest, dataset).moving(), 0.0) << seed;
    }
  }
}

TEST(DecideRest, TrueRestsStay) {
  const PerfectRecording recording(LoadCorners("corners"));
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    Dataset dataset = recording.Realize(seed);
    const auto standing = static_cast<double>(
        std::count_if(dataset.truth.begin(), dataset.truth.end(), Stands));
    const double step = dataset.truth[1].t - dataset.truth[0].t;
    const Seconds found = Count(DecideRest(&dataset).at_rest, dataset);
    EXPECT_GE(found.standing, 0.95 * standing * step) << seed;
    EXPECT_EQ(found.moving(), 0.0) << seed;
  }
}

TEST(DecideRest, StopsInAnOutageAreFoundByTheEstimate) {
  // No fix from 5 s before the last stop on: what the IMU carries shows it.
  Scenario scenario = LoadCorners("corners");
  const PerfectRecording whole(scenario);
  const double end = whole.Realize(1).imu.t_end();
  scenario.aiding[0].outages = {{end - 15.0, end - 1.0}};
  const PerfectRecording recording(scenario);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Dataset dataset = recording.Realize(seed);
    const Rest rest = DecideRest(&dataset);
    ASSERT_FALSE(rest.at_rest.empty());
    EXPECT_GT(rest.at_rest.back().end, end - 2.0) << seed;
    EXPECT_EQ(Count(rest.at_rest, dataset).moving(), 0.0) << seed;
  }
}

TEST(DecideRest, TheTunnelSurveyNeverStands) {
  Dataset dataset = Simulate(FindScenario("tunnel_survey"), 1);
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
}

/// An IMU that a hand shakes (10 s), lifts by 0.4 m (6 s), turns on the spot by
/// 180 deg (20 s), and leaves alone between; positions to 5 mm.
Scenario HandHeld() {
  Scenario scenario;
  scenario.name = "hand_held";
  const Geodetic place = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  const auto smooth = [](double t, double from, double to) {
    const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
    return s * s * s * (10.0 + s * (6.0 * s - 15.0));
  };
  const double R = MeridianRadius(place.latitude) + place.height;
  const auto at = [&](double t) {
    ProfilePoint point;
    point.t = t;
    const double shaken = smooth(t, 5.0, 6.0) * smooth(t, 15.0, 14.0);
    const double north = 0.02 * shaken * std::sin(2.0 * kPi * 1.5 * t);
    point.euler = {0.15 * shaken * std::sin(2.0 * kPi * 1.1 * t),
                   0.1 * shaken * std::cos(2.0 * kPi * 0.7 * t),
                   kPi * smooth(t, 30.0, 50.0) + 0.1 * shaken};
    point.position = {place.latitude + north / R, place.longitude,
                      place.height + 0.4 * smooth(t, 20.0, 26.0)};
    return point;
  };
  constexpr double kStep = 0.01;
  for (int k = 0; k <= 6000; ++k) {
    const double t = kStep * k;
    ProfilePoint point = at(t);
    const ProfilePoint before = at(t - 1e-4);
    const ProfilePoint after = at(t + 1e-4);
    point.v_n = {
        (after.position.latitude - before.position.latitude) * R / 2e-4, 0.0,
        -(after.position.height - before.position.height) / 2e-4};
    scenario.profile.push_back(point);
  }
  scenario.imu_kind = ImuStream::Kind::kRates;
  scenario.imu_rate_hz = 100.0;
  scenario.imu.noise.gyro_noise_density = 0.01 * kDegree;
  scenario.imu.noise.accel_noise_density = 1e-3;
  scenario.imu.gyro_bias_sigma.setConstant(0.2 * kDegree);
  scenario.imu.accel_bias_sigma.setConstant(0.02);
  AidingModel positions(PositionKind());
  positions.sensor.name = "positions";
  positions.sigma.emplace().setConstant(0.005);
  positions.rate_hz = 10.0;
  scenario.aiding = {positions};
  scenario.stationary.enabled = true;
  return scenario;
}

TEST(DecideRest, AnImuInAHandIsNotAtRest) {
  const PerfectRecording recording(HandHeld());
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Dataset dataset = recording.Realize(seed);
    const Rest rest = DecideRest(&dataset);
    const auto overlap = [&rest](double from, double to) {
      double total = 0.0;
      for (const TimeInterval& span : rest.at_rest) {
        total +=
            std::max(0.0, std::min(to, span.end) - std::max(from, span.begin));
      }
      return total;
    };
    EXPECT_EQ(overlap(5.8, 14.2), 0.0) << seed;   // shaken
    EXPECT_EQ(overlap(21.5, 24.5), 0.0) << seed;  // lifted
    EXPECT_EQ(overlap(33.0, 47.0), 0.0) << seed;  // turned
    EXPECT_GT(overlap(0.0, 5.0), 3.5) << seed;
    EXPECT_GT(overlap(51.0, 60.0), 7.0) << seed;
    // What begins in the hand gives no bias from there.
    for (const double from : {7.0, 31.0}) {
      const Start start = FindStart(dataset, from, 60.0);
      const Eigen::Vector3d error =
          dataset.truth.front().b_g.value() - start.report.state.b_g;
      const int b = start.layout.Find(BlockKind::kGyroBias)->offset;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(std::abs(error(axis)),
                  4.0 * std::sqrt(start.prior.P(b + axis, b + axis)))
            << seed << " " << from;
      }
    }
  }
}

}  // namespace
}  // namespace hindsight
