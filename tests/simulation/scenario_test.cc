#include "simulation/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

Scenario Small() {
  Scenario s = FindScenario("car_drive");
  s.duration = 40.0;
  s.imu_rate_hz = 50.0;
  s.withholdings.clear();
  return s;
}

void ExpectSame(const Dataset& a, const Dataset& b) {
  ASSERT_EQ(a.imu.samples.size(), b.imu.samples.size());
  for (std::size_t k = 0; k < a.imu.samples.size(); ++k) {
    ASSERT_EQ(a.imu.samples[k].t, b.imu.samples[k].t);
    ASSERT_EQ(a.imu.samples[k].gyro, b.imu.samples[k].gyro);
    ASSERT_EQ(a.imu.samples[k].accel, b.imu.samples[k].accel);
  }
  ASSERT_EQ(a.truth.size(), b.truth.size());
  for (std::size_t k = 0; k < a.truth.size(); ++k) {
    ASSERT_EQ(*a.truth[k].p_e, *b.truth[k].p_e);
    ASSERT_EQ(*a.truth[k].b_g, *b.truth[k].b_g);
  }
  ASSERT_EQ(a.streams.size(), b.streams.size());
  for (std::size_t s = 0; s < a.streams.size(); ++s) {
    const auto& x = a.streams[s].measurements;
    const auto& y = b.streams[s].measurements;
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      ASSERT_EQ(x[k].t, y[k].t);
      ASSERT_EQ(std::get<PositionFix>(x[k].model).p_e,
                std::get<PositionFix>(y[k].model).p_e);
    }
  }
  ASSERT_EQ(*a.initial.v_n, *b.initial.v_n);
}

TEST(Simulate, SameSeedGivesTheSameDataAndAnotherSeedDoesNot) {
  const Dataset a = Simulate(Small(), 7);
  ExpectSame(a, Simulate(Small(), 7));
  const Dataset b = Simulate(Small(), 8);
  EXPECT_NE(a.imu.samples[5].gyro, b.imu.samples[5].gyro);
  EXPECT_NE(std::get<PositionFix>(a.streams[0].measurements[3].model).p_e,
            std::get<PositionFix>(b.streams[0].measurements[3].model).p_e);
  EXPECT_EQ(*a.truth[9].p_e, *b.truth[9].p_e);
}

TEST(Simulate, RealizingASeedEqualsSimulatingIt) {
  Scenario scenario = Small();
  scenario.imu.noise.gyro_bias_walk = 1e-6;
  const PerfectRecording recording(scenario);
  ExpectSame(recording.Realize(3), Simulate(scenario, 3));
  ExpectSame(recording.Realize(4), Simulate(scenario, 4));
}

TEST(Simulate, AddingASensorLeavesTheOthersErrorsAlone) {
  Scenario more = Small();
  AidingModel height(HeightKind());
  height.sensor.name = "barometer";
  more.aiding.insert(more.aiding.begin(), height);
  const Dataset a = Simulate(Small(), 7);
  const Dataset b = Simulate(more, 7);
  EXPECT_EQ(a.imu.samples[100].accel, b.imu.samples[100].accel);
  EXPECT_EQ(b.streams[1].measurements[3].sensor, 1);
  EXPECT_EQ(std::get<PositionFix>(a.streams[0].measurements[3].model).p_e,
            std::get<PositionFix>(b.streams[1].measurements[3].model).p_e);
}

TEST(Simulate, InitialErrorsHaveTheStatedSigma) {
  Scenario scenario = Small();
  scenario.duration = 1.0;
  const PerfectRecording recording(scenario);
  const int n = 1000;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();
  for (int seed = 0; seed < n; ++seed) {
    const Dataset d = recording.Realize(static_cast<std::uint64_t>(seed));
    const TruthPoint truth = d.truth.front();
    position += (NedAxes(*truth.p_e).transpose() *
                 (EcefFromGeodetic(*d.initial.position) - *truth.p_e))
                    .cwiseQuotient(*d.initial.position_sigma)
                    .cwiseAbs2();
    velocity += (*d.initial.v_n - *truth.v_n)
                    .cwiseQuotient(*d.initial.velocity_sigma)
                    .cwiseAbs2();
    attitude += (*d.initial.euler - EulerFromQuaternion(*truth.q_nb))
                    .cwiseQuotient(*d.initial.attitude_sigma)
                    .cwiseAbs2();
  }
  const double bound = 3.89 * std::sqrt(2.0 / n);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(position(axis) / n, 1.0, bound);
    EXPECT_NEAR(velocity(axis) / n, 1.0, bound);
    EXPECT_NEAR(attitude(axis) / n, 1.0, bound);
  }
}

TEST(Simulate, TellsWhatItDrewFrom) {
  const Scenario scenario = Small();
  const Dataset d = Simulate(scenario, 1);
  EXPECT_EQ(d.imu.noise.gyro_noise_density,
            scenario.imu.noise.gyro_noise_density);
  EXPECT_EQ(d.imu.noise.accel_noise_density,
            scenario.imu.noise.accel_noise_density);
  EXPECT_EQ(*d.initial.gyro_bias_sigma, scenario.imu.gyro_bias_sigma);
  EXPECT_EQ(d.streams[0].sensor.lever_arm_b,
            scenario.aiding[0].sensor.lever_arm_b);
  const auto fix = std::get<PositionFix>(d.streams[0].measurements[0].model);
  EXPECT_LT((fix.R_n.diagonal() - Eigen::Vector3d(25e-4, 25e-4, 1e-2)).norm(),
            1e-15);
}

TEST(Simulate, KeepsTheAskedDurationAndRates) {
  const Dataset d = Simulate(Small(), 1);
  EXPECT_EQ(d.imu.samples.size(), 2001U);
  EXPECT_EQ(d.imu.t_begin(), 0.0);
  EXPECT_EQ(d.imu.t_end(), 40.0);
  EXPECT_EQ(d.truth.size(), 401U);
  EXPECT_EQ(d.truth.back().t, 40.0);
  EXPECT_EQ(d.streams[0].measurements.size(), 41U);
}

TEST(Simulate, ADayCostsTimeInProportionAndKeepsOnlyTheTruth) {
  Scenario day = Small();
  day.segments = WanderingDrive(86400.0, 1);
  day.duration = 86400.0;
  day.imu_rate_hz = 4.0;
  day.truth_rate_hz = 1.0 / 60.0;
  day.aiding[0].rate_hz = 1.0 / 60.0;
  Simulation simulation(day, 1);
  ImuSample sample;
  std::size_t count = 0;
  while (simulation.Next(&sample)) ++count;
  EXPECT_EQ(count, 345601U);
  const Dataset d = simulation.Finish();
  EXPECT_TRUE(d.imu.samples.empty());
  EXPECT_EQ(d.truth.size(), 1441U);
  EXPECT_EQ(d.streams[0].measurements.size(), 1441U);
}

TEST(FindScenario, CarDriveIsWhatItsNameSays) {
  const Dataset d = Simulate(FindScenario("car_drive"), 1);
  EXPECT_EQ(d.imu.samples.size(), 360001U);
  EXPECT_EQ(d.imu.kind, ImuStream::Kind::kIncrements);
  ASSERT_EQ(d.outages.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(d.outages[k].t_begin, 450.0 * static_cast<double>(k + 1));
    EXPECT_EQ(d.outages[k].t_end, d.outages[k].t_begin + 60.0);
    double distance = 0.0;
    for (const TruthPoint& p : d.truth) {
      if (p.t >= d.outages[k].t_begin && p.t < d.outages[k].t_end) {
        distance += 0.1 * p.v_n->norm();
      }
    }
    EXPECT_GT(distance, 300.0) << k;
  }
}

TEST(FindScenario, ShortDriveStandsThenMovesAndStopsTwice) {
  const Dataset d = Simulate(FindScenario("short_drive"), 1);
  EXPECT_EQ(d.imu.t_end(), 180.0);
  EXPECT_EQ(d.streams.size(), 2U);
  EXPECT_FALSE(d.initial.position.has_value());
  int stops = 0;
  bool standing = false;
  for (const TruthPoint& p : d.truth) {
    const bool now = p.v_n->norm() == 0.0;
    stops += now && !standing ? 1 : 0;
    standing = now;
    EXPECT_TRUE(now || p.t >= 20.0) << p.t;
  }
  EXPECT_EQ(stops, 3);  // the start, one on the way, the end
}

TEST(FindScenario, RefusesAnUnknownNameAndListsTheKnown) {
  for (const std::string& name : ScenarioNames()) {
    EXPECT_EQ(FindScenario(name).name, name);
  }
  try {
    FindScenario("boat");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("car_drive"));
  }
}

TEST(Scenario, RefusesRatesThatAreNotPositive) {
  Scenario s = Small();
  s.imu_rate_hz = 0.0;
  EXPECT_THROW(Simulate(s, 1), InputError);
  s = Small();
  s.truth_rate_hz = std::nan("");
  EXPECT_THROW(Simulate(s, 1), InputError);
  s = Small();
  s.aiding[0].rate_hz = -1.0;
  EXPECT_THROW(Simulate(s, 1), InputError);
}

}  // namespace
}  // namespace hindsight
