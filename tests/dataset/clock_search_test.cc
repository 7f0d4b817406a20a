#include "dataset/clock_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "simulation/scenario.h"
#include "simulation/wandering_drive.h"
#include "support/seed_count.h"
#include "support/shuttle_flight.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Three minutes of driving, the truth once a second and by `late` seconds
/// late.
Dataset LateTruth(double late) {
  Scenario scenario = FindScenario("short_drive");
  scenario.truth_rate_hz = 1.0;
  Dataset dataset = Simulate(scenario, 1);
  for (TruthPoint& point : dataset.truth.Edited()) point.t += late;
  return dataset;
}

TEST(ClockSearch, TruthsClockIsFoundFromTheGyros) {
  for (const double late : {-0.455, 0.0, 1.237, 2.5, -61.3, 1000.0}) {
    const Dataset dataset = LateTruth(late);
    const ClockSearch found = SearchClock(dataset.imu, dataset.truth);
    ASSERT_FALSE(found.candidates.empty()) << late;
    const ClockCandidate& clock = found.candidates.front();
    EXPECT_NEAR(clock.offset, -late, 4.0 * clock.sigma + 1e-4);
    EXPECT_LT(clock.sigma, 5e-3);
  }
}

TEST(ClockSearch, TruthsClockIsNotFoundWhereNothingTellsIt) {
  Dataset straight = LateTruth(0.0);
  for (TruthPoint& point : straight.truth.Edited()) {
    point.q_nb = Eigen::Quaterniond::Identity();
  }
  for (ImuSample& sample : straight.imu.samples) {
    sample.gyro = 1e-5 * Eigen::Vector3d(std::sin(100.0 * sample.t), 0.0, 0.0);
  }
  EXPECT_TRUE(SearchClock(straight.imu, straight.truth).candidates.empty());
  Dataset positions = LateTruth(0.0);
  for (TruthPoint& point : positions.truth.Edited()) point.q_nb.reset();
  EXPECT_TRUE(SearchClock(positions.imu, positions.truth).candidates.empty());
}

AidingModel Model(const SensorKind& kind, const Eigen::Vector3d& sigma,
                  double rate_hz) {
  AidingModel model(kind);
  model.sensor.name = "sensor";
  model.sigma = sigma;
  model.rate_hz = rate_hz;
  return model;
}

/// Every kind of stream that can tell its clock, on a drive.
std::vector<AidingModel> TellingSensors() {
  std::vector<AidingModel> models = {
      Model(PositionKind(), Eigen::Vector3d::Constant(0.5), 1.0),
      Model(PositionKind(), Eigen::Vector3d::Constant(0.05), 5.0),
      Model(VelocityKind(), Eigen::Vector3d::Constant(0.05), 5.0),
      Model(OdometerKind(), Eigen::Vector3d::Constant(0.05), 10.0),
      Model(DvlKind(), Eigen::Vector3d::Constant(0.02), 2.0),
      Model(MagnetometerKind(), Eigen::Vector3d::Constant(0.5), 20.0)};
  PatternOf<Odometer>(models[3]).form = Odometer::Form::kForward;
  PatternOf<MagneticField>(models[5]).form = MagneticField::Form::kVector;
  return models;
}

Dataset Drive(const AidingModel& model, std::uint64_t seed) {
  Scenario scenario = FindScenario("short_drive");
  scenario.segments = WanderingDrive(180.0, seed);
  scenario.aiding = {model};
  return Simulate(scenario, seed);
}

TEST(ClockSearch, FindsDelaysUpToHalfTheRecordingOfEveryKindOfStream) {
  std::vector<double> lates = {-85.0, 0.7, 1e6};
  if (testing::kSanitized) lates.resize(1);
  for (const AidingModel& model : TellingSensors()) {
    Dataset dataset = Drive(model, 11);
    AidingStream& stream = dataset.streams[0];
    double delayed = 0.0;
    for (const double late : lates) {
      Delay(late - delayed, &stream);
      delayed = late;
      const ClockSearch found =
          SearchClock(dataset.imu, dataset.initial, stream);
      ASSERT_FALSE(found.candidates.empty())
          << model.sensor.kind->name << " " << late;
      // Windows hide what their length hides.
      EXPECT_NEAR(found.candidates.front().offset, -late,
                  0.25 * found.resolution)
          << model.sensor.kind->name << " " << late;
    }
  }
}

TEST(ClockSearch, FindsTheClockOfARecordThatBeganEarlierAndEndedLater) {
  AidingModel model =
      Model(VelocityKind(), Eigen::Vector3d::Constant(0.05), 5.0);
  Dataset dataset = Drive(model, 12);
  auto& samples = dataset.imu.samples;
  EraseIf(
      [](const ImuSample& sample) {
        return sample.t < 70.0 || sample.t > 130.0;
      },
      &samples);
  Delay(-40.0, &dataset.streams[0]);
  const ClockSearch found =
      SearchClock(dataset.imu, dataset.initial, dataset.streams[0]);
  ASSERT_FALSE(found.candidates.empty());
  EXPECT_NEAR(found.candidates.front().offset, 40.0, 0.1);
}

TEST(ClockSearch, FindsNothingAtRest) {
  for (const AidingModel& model : TellingSensors()) {
    Scenario scenario = FindScenario("short_drive");
    scenario.segments = {Segment::Stop(120.0)};
    scenario.aiding = {model};
    const Dataset dataset = Simulate(scenario, 3);
    EXPECT_TRUE(SearchClock(dataset.imu, dataset.initial, dataset.streams[0])
                    .candidates.empty())
        << model.sensor.kind->name;
  }
}

/// What is free in each piece fits any smooth motion, and a velocity that is
/// constant in the body fits any turn: neither tells a clock.
TEST(ClockSearch, MotionThatFitsAnywhereTellsNothing) {
  for (const auto& [scenario, stream] :
       {std::pair("test_aircraft", "barometer"), {"test_dive", "dvl"}}) {
    const Dataset dataset = Simulate(FindScenario(scenario), 3);
    for (const AidingStream& one : dataset.streams) {
      if (one.sensor.name != stream) continue;
      EXPECT_TRUE(
          SearchClock(dataset.imu, dataset.initial, one).candidates.empty())
          << stream;
    }
  }
}

/// Noise alone is between the misfits of a flight half a period off.
TEST(ClockSearch, WhatNoiseMayHaveMadeWorseIsPlausible) {
  ShuttleOptions periodic;
  periodic.irregularity = periodic.drift = periodic.turning = 0.0;
  for (const std::uint64_t seed : {61u, 62u, 63u, 64u}) {
    const Dataset regular = LateShuttle(periodic, seed, 0.3, 0.5);
    const ClockSearch found = SearchClock(regular.imu, regular.initial,
                                          regular.streams[0], {-2.0, 2.0});
    ASSERT_GE(found.candidates.size(), 2u);
    EXPECT_TRUE(IsPlausible(found, found.candidates.back().misfit)) << seed;
  }
  const Dataset drive = Drive(TellingSensors()[0], 13);
  const ClockSearch found =
      SearchClock(drive.imu, drive.initial, drive.streams[0]);
  ASSERT_FALSE(found.candidates.empty());
  EXPECT_TRUE(IsPlausible(found, found.candidates.front().misfit));
  EXPECT_FALSE(IsPlausible(found, found.misfit(20.0)));
}

TEST(ClockSearch, HalfAPeriodOffIsACandidateOfAFlightToAndFro) {
  const Dataset dataset = LateShuttle({}, 5, 0.6, 0.5);
  const ClockSearch found = SearchClock(dataset.imu, dataset.initial,
                                        dataset.streams[0], {-2.0, 2.0});
  ASSERT_GE(found.candidates.size(), 2u);
  const auto finds = [&](double offset) {
    return std::any_of(found.candidates.begin(), found.candidates.end(),
                       [&](const ClockCandidate& candidate) {
                         return std::abs(candidate.offset - offset) < 0.15;
                       });
  };
  EXPECT_TRUE(finds(-0.6));
  EXPECT_TRUE(finds(-0.6 + 0.5 * 2.7));
}

TEST(ClockSearch, SeveralClocksOfARegularFlightAreTold) {
  ShuttleOptions periodic;
  periodic.irregularity = periodic.drift = periodic.turning = 0.0;
  Dataset regular = LateShuttle(periodic, 65, 0.3, 0.5);
  EXPECT_THAT(FindAmbiguousClocks(regular), IsEmpty()) << "it is given";
  regular.streams[0].sensor.time_offset_sigma.reset();
  regular.streams[0].clock_unknown = true;
  EXPECT_THAT(FindAmbiguousClocks(regular),
              ElementsAre(AllOf(HasSubstr("gnss: 8 time offsets from "),
                                HasSubstr(" and further ones fit about as "
                                          "well: `run` decides"))));
  Dataset drive = Drive(TellingSensors()[0], 13);
  drive.streams[0].clock_unknown = true;
  EXPECT_THAT(FindAmbiguousClocks(drive), IsEmpty());
}

TEST(ClockSearch, WithheldMeasurementsTakeNoPart) {
  Dataset dataset =
      Drive(Model(VelocityKind(), Eigen::Vector3d::Constant(0.05), 5.0), 13);
  for (Measurement& z : dataset.streams[0].measurements.Edited())
    z.withheld = true;
  EXPECT_TRUE(SearchClock(dataset.imu, dataset.initial, dataset.streams[0])
                  .candidates.empty());
}

TEST(ClockSearch, ASigmaThatIsNoNumberIsSaidToBeUnknown) {
  ClockSearch search;
  search.candidates = {{0.25, 0.003, 0.1}, {-1.5, std::nan(""), 0.2}};
  search.compared = "positions";
  EXPECT_EQ(Describe(search),
            "0.2500 s, sigma 3 ms, misfit 0.1; or -1.5000 s, sigma unknown, "
            "misfit 0.2; from positions");
}

TEST(ClockSearch, OffsetsLeaveHalfOfTheShorterRecord) {
  const OffsetRange range = OverlappingOffsets(100.0, 200.0, 0.0, 20.0);
  EXPECT_DOUBLE_EQ(range.from, 90.0);
  EXPECT_DOUBLE_EQ(range.to, 190.0);
}

}  // namespace
}  // namespace hindsight
