#include "dataset/repeated_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "io/config/scenario_config.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// A minute at 100 Hz with noise of `steps` least significant bits.
ImuStream Imu(double steps) {
  ImuStream imu;
  imu.nominal_dt = 0.01;
  Random random(1);
  constexpr double kBit = 1e-3;
  const auto reading = [&] {
    const Eigen::Vector3d v = steps * random.NormalVector3();
    return Eigen::Vector3d(kBit * v.array().round().matrix());
  };
  for (int k = 0; k < 6000; ++k) {
    imu.samples.push_back({0.01 * k, reading(), reading()});
  }
  return imu;
}

void Freeze(double from, double to, ImuStream* imu) {
  const ImuSample* held = nullptr;
  for (ImuSample& sample : imu->samples) {
    if (sample.t < from || sample.t > to) continue;
    if (held == nullptr) held = &sample;
    sample.gyro = held->gyro;
    sample.accel = held->accel;
  }
}

TEST(FrozenImu, IsFoundWithItsTime) {
  for (const double steps : {0.2, 1.0, 100.0}) {
    ImuStream imu = Imu(steps);
    EXPECT_TRUE(FindFrozenImu(imu).empty()) << steps;
    Freeze(20.0, 25.0, &imu);
    const std::vector<RepeatedRun> found = FindFrozenImu(imu);
    ASSERT_EQ(found.size(), 1u) << steps;
    // A coarse reading may happen to repeat at the ends.
    EXPECT_NEAR(found[0].t_begin, 20.0, 1.0);
    EXPECT_NEAR(found[0].t_end, 25.0, 1.0);
  }
}

TEST(FrozenImu, IsFoundAsOftenAsItHappens) {
  ImuStream imu = Imu(1.0);
  for (const double t : {10.0, 20.0, 30.0, 40.0}) Freeze(t, t + 3.0, &imu);
  EXPECT_EQ(FindFrozenImu(imu).size(), 4u);
}

/// A sensor so coarse that it rests on the same reading for a second.
TEST(FrozenImu, CoarseReadingsRepeatByThemselves) {
  const ImuStream imu = Imu(0.2);
  long longest = 0;
  long run = 0;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const bool same = imu.samples[k].gyro == imu.samples[k - 1].gyro &&
                      imu.samples[k].accel == imu.samples[k - 1].accel;
    run = same ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  ASSERT_GT(longest, 50);
  EXPECT_TRUE(FindFrozenImu(imu).empty());
}

TEST(FrozenImu, GyrosAndSingleAxesAreFoundBesideLiveOnes) {
  const auto freeze = [](int first, int last, ImuStream* imu) {
    const ImuSample held = imu->samples[2000];
    for (std::size_t k = 2000; k < 2600; ++k) {
      for (int c = first; c < last; ++c) {
        (c < 3 ? imu->samples[k].gyro(c) : imu->samples[k].accel(c - 3)) =
            c < 3 ? held.gyro(c) : held.accel(c - 3);
      }
    }
  };
  const auto found = [&](int first, int last) {
    ImuStream imu = Imu(100.0);
    freeze(first, last, &imu);
    const std::vector<RepeatedRun> runs = FindFrozenImu(imu);
    EXPECT_EQ(runs.size(), 1u);
    if (runs.size() != 1) return std::string("none");
    EXPECT_NEAR(runs[0].t_begin, 20.0, 0.011);
    EXPECT_NEAR(runs[0].t_end, 25.99, 0.011);
    return std::string(runs[0].channel);
  };
  EXPECT_EQ(found(0, 3), "gyro triad");
  EXPECT_EQ(found(3, 6), "accelerometer triad");
  EXPECT_EQ(found(2, 3), "gyro z");
  EXPECT_EQ(found(4, 5), "accelerometer y");
}

/// Gyros that read vibrations of 20 steps on the way, and at rest a tenth of
/// one, as the accelerometers do.
TEST(FrozenImu, CoarseGyrosAreStillAtRest) {
  ImuStream imu = Imu(20.0);
  for (ImuSample& sample : imu.samples) {
    const bool rests = std::fmod(sample.t, 20.0) > 12.0;
    if (!rests) continue;
    sample.gyro = 1e-3 * (0.005 * sample.gyro / 1e-3).array().round();
    sample.accel *= 0.01;
  }
  imu.samples[1500].gyro.z() += 1e-3;
  for (const RepeatedRun& run : FindFrozenImu(imu)) {
    ADD_FAILURE() << run.channel << " at " << run.t_begin;
  }
}

constexpr double kStep = 1.0 / 6.37e6;  // a metre of latitude [rad]

/// Ten minutes along the meridian at `rate`; `Hold` turns the time of a row
/// into that of the reading that it has, `resolution` in metres.
template <typename Hold>
AidingStream Positions(double rate, double speed, double resolution,
                       Hold hold) {
  AidingStream stream;
  stream.sensor.name = "gnss";
  for (int k = 0; k < 600 * rate; ++k) {
    const double t = k / rate;
    const double at = hold(t);
    const auto grid = [resolution](double metres) {
      return resolution * std::round(metres / resolution);
    };
    PositionFix fix;
    fix.p_e = EcefFromGeodetic(
        {0.8 + kStep * grid(speed * at + 0.37 * std::sin(1.3 * at)), 0.1,
         grid(100.0 + 3.0 * std::sin(0.1 * at))});
    stream.measurements.push_back({.t = t, .model = fix});
  }
  return stream;
}

TEST(StaleShare, OfPositionsWrittenFasterThanMeasured) {
  const auto each_second = [](double t) { return std::floor(t + 1e-9); };
  EXPECT_NEAR(StaleShare(Positions(25.0, 10.0, 1e-3, each_second)), 0.96, 0.01);
  EXPECT_NEAR(StaleShare(Positions(4.0, 10.0, 1e-3, each_second)), 0.75, 0.01);
  EXPECT_EQ(StaleShare(Positions(1.0, 10.0, 1e-3, each_second)), 0.0);
}

/// Each sample said so often as it is polled faster than it is measured.
ImuStream Polled(ImuStream imu, std::size_t times) {
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    const ImuSample held = imu.samples[k - k % times];
    imu.samples[k].gyro = held.gyro;
    imu.samples[k].accel = held.accel;
  }
  return imu;
}

TEST(StaleShare, OfAnImuThatIsPolledFasterThanItMeasures) {
  EXPECT_EQ(StaleImuShare(Imu(100.0)), 0.0);
  EXPECT_NEAR(StaleImuShare(Polled(Imu(100.0), 2)), 0.5, 0.001);
  EXPECT_NEAR(StaleImuShare(Polled(Imu(100.0), 4)), 0.75, 0.001);
  // At rest coarse samples repeat by right.
  EXPECT_EQ(StaleImuShare(Imu(0.2)), 0.0);
  Dataset dataset;
  dataset.imu = Polled(Imu(100.0), 4);
  const std::vector<Evidence> found = FindRepeatedReadings(dataset, 0.0, 60.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].rule, "stale_readings");
  EXPECT_EQ(found[0].grade, Grade::kDoubtful);
}

TEST(StaleShare, NotOfACoarseReceiverOnASlowVehicle) {
  const auto now = [](double t) { return t; };
  EXPECT_EQ(StaleShare(Positions(10.0, 0.5, 0.18, now)), 0.0);
}

/// Half a minute of driving, then half a minute at rest with the position held.
TEST(StaleShare, NotOfAReceiverThatHoldsItsPositionAtRest) {
  const auto stop_and_go = [](double t) {
    const double cycle = std::floor(t / 60.0);
    return 30.0 * cycle + std::min(t - 60.0 * cycle, 30.0);
  };
  EXPECT_LT(StaleShare(Positions(10.0, 10.0, 1e-3, stop_and_go)), 0.02);
}

TEST(RepeatedReadings, GradeByHowOftenAReadingIsCounted) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  const auto evidence = [&](double rate) {
    dataset.streams = {Positions(
        rate, 10.0, 1e-3, [](double t) { return std::floor(t + 1e-9); })};
    return FindRepeatedReadings(dataset, 0.0, 60.0);
  };
  EXPECT_TRUE(evidence(1.0).empty());
  ASSERT_EQ(evidence(4.0).size(), 1u);
  EXPECT_EQ(evidence(4.0)[0].grade, Grade::kDoubtful);
  ASSERT_EQ(evidence(25.0).size(), 1u);
  EXPECT_EQ(evidence(25.0)[0].rule, "stale_readings");
  EXPECT_EQ(evidence(25.0)[0].grade, Grade::kUnusable);
  EXPECT_NEAR(*evidence(25.0)[0].value, 96.0, 1.0);
  EXPECT_NE(evidence(25.0)[0].what.find("gnss"), std::string::npos);
}

TEST(RepeatedReadings, FrozenImuIsDoubtfulWithinTheInterval) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  Freeze(20.0, 25.0, &dataset.imu);
  EXPECT_TRUE(FindRepeatedReadings(dataset, 30.0, 60.0).empty());
  const auto evidence = FindRepeatedReadings(dataset, 0.0, 60.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].rule, "frozen_imu");
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_NEAR(*evidence[0].t_begin, 20.0, 0.02);
  EXPECT_NEAR(*evidence[0].value, 5.0, 0.02);
}

/// An axis that never read anything is named, unless it is one of two that have
/// no sensor, or nothing shows noise.
TEST(RepeatedReadings, AnAxisThatIsDeadFromTheFirstSampleIsNamed) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  for (ImuSample& sample : dataset.imu.samples) sample.accel.y() = 0.0;
  const auto evidence = FindRepeatedReadings(dataset, 0.0, 60.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].rule, "frozen_imu");
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_NE(evidence[0].what.find("accelerometer y of imu"), std::string::npos);
  EXPECT_EQ(evidence[0].remedies[0], "the columns of the IMU");
  for (ImuSample& sample : dataset.imu.samples) sample.accel.x() = 0.0;
  EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 60.0).empty());
  for (ImuSample& sample : dataset.imu.samples) {
    sample.accel = {std::sin(sample.t), 0.0, std::cos(sample.t)};
  }
  EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 60.0).empty());
}

TEST(RepeatedReadings, FrozenPositionsAreDoubtfulUnlessTheVehicleRests) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  const auto frozen = [](double t) { return t > 20.0 && t < 40.0 ? 20.0 : t; };
  dataset.streams = {Positions(10.0, 10.0, 1e-3, frozen)};
  const auto evidence = FindRepeatedReadings(dataset, 0.0, 600.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].rule, "frozen_stream");
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_NEAR(*evidence[0].t_begin, 20.0, 0.11);
  EXPECT_NEAR(*evidence[0].t_end, 40.0, 0.11);
  const auto stops = [](double t) {
    return t < 20.0 ? t : std::max(20.0, t - 20.0);
  };
  dataset.streams = {Positions(10.0, 10.0, 1e-3, stops)};
  EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 600.0).empty());
}

/// Positions with sigmas of half a metre.
AidingStream Fixes(double rate, double speed, double (*hold)(double)) {
  AidingStream stream = Positions(rate, speed, 1e-3, hold);
  for (Measurement& z : stream.measurements.Edited()) {
    std::get<PositionFix>(z.model).R_n = 0.25 * Eigen::Matrix3d::Identity();
  }
  return stream;
}

TEST(RepeatedReadings, FewFrozenFixesAtSpeedAreDoubtful) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  dataset.streams = {Fixes(
      1.0, 8.0, [](double t) { return t > 30.0 && t < 33.5 ? 30.0 : t; })};
  const auto evidence = FindRepeatedReadings(dataset, 0.0, 600.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].rule, "frozen_stream");
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_DOUBLE_EQ(*evidence[0].t_begin, 30.0);
  EXPECT_DOUBLE_EQ(*evidence[0].t_end, 33.0);
}

/// Stops of 5 s every 40 s, which are left at 2 m/s^2.
TEST(RepeatedReadings, ShortStopsOfAReceiverThatHoldsItsPositionAreUsable) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  for (const double rate : {1.0, 5.0}) {
    dataset.streams = {Fixes(rate, 8.0, [](double t) {
      const double cycle = std::floor(t / 40.0);
      const double u = t - 40.0 * cycle;
      const double along = u < 4.0    ? u * u / 8.0
                           : u < 31.0 ? u - 2.0
                           : u < 35.0 ? 31.0 - (35.0 - u) * (35.0 - u) / 8.0
                                      : 31.0;
      return 31.0 * cycle + along;
    })};
    EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 600.0).empty()) << rate;
  }
}

TEST(RepeatedReadings, EverySecondRowAtSpeedIsDoubtful) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  dataset.streams = {
      Fixes(1.0, 8.0, [](double t) { return 2.0 * std::floor(0.5 * t); })};
  const auto evidence = FindRepeatedReadings(dataset, 0.0, 600.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].rule, "stale_readings");
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
}

/// Ten minutes at 10 Hz of speeds, heights and fields, each as Reading makes it
/// of the time and rounded to its resolution.
template <typename Reading>
AidingStream Readings(Reading reading) {
  AidingStream stream;
  stream.sensor.name = "sensor";
  for (int k = 0; k < 6000; ++k) {
    stream.measurements.push_back({.t = 0.1 * k, .model = reading(0.1 * k)});
  }
  return stream;
}

double Rounded(double value, double resolution) {
  return resolution * std::round(value / resolution);
}

double Speed(double t) {
  return Rounded(12.0 + 6.0 * std::sin(0.05 * t) + 0.8 * std::sin(0.9 * t),
                 0.01);
}

MeasurementModel OfOdometer(double t) { return Odometer{.speed = Speed(t)}; }
MeasurementModel OfCourse(double t) {
  return SpeedCourse{.speed = Speed(t),
                     .course = Rounded(std::sin(0.03 * t), 1e-3)};
}
MeasurementModel OfDvl(double t) {
  Dvl dvl;
  dvl.speed << Speed(t), Rounded(0.3 * std::sin(0.7 * t), 0.01), 0.0, 0.0;
  return dvl;
}
MeasurementModel OfDepth(double t) {
  return HeightFix{Rounded(-30.0 + 10.0 * std::sin(0.02 * t), 0.01)};
}
MeasurementModel OfField(double t) {
  const double heading = 0.4 * std::sin(0.11 * t) + 0.02 * t;
  return MagneticField{.field_b = {Rounded(20.0 * std::cos(heading), 0.05),
                                   Rounded(-20.0 * std::sin(heading), 0.05),
                                   Rounded(40.0, 0.05)}};
}

TEST(RepeatedReadings, FrozenStreamsOfEveryKindAreFound) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  for (const auto& of : {OfOdometer, OfCourse, OfDvl, OfDepth, OfField}) {
    dataset.streams = {Readings(of)};
    EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 600.0).empty());
    dataset.streams = {Readings(
        [&of](double t) { return of(t > 203.0 && t < 223.0 ? 203.0 : t); })};
    const auto evidence = FindRepeatedReadings(dataset, 0.0, 600.0);
    ASSERT_EQ(evidence.size(), 1u);
    EXPECT_EQ(evidence[0].rule, "frozen_stream");
    EXPECT_NEAR(*evidence[0].t_begin, 203.0, 0.3);
    EXPECT_NEAR(*evidence[0].t_end, 223.0, 0.3);
    dataset.streams = {Readings([&of](double t) { return of(std::floor(t)); })};
    EXPECT_EQ(FindRepeatedReadings(dataset, 0.0, 600.0).at(0).rule,
              "stale_readings");
  }
}

/// Stops of half a minute, left at 3 m/s^2: the first reading after one is of a
/// speed of its own.
TEST(RepeatedReadings, OdometerAtRestRepeatsZeroByRight) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  dataset.streams = {Readings([](double t) -> MeasurementModel {
    const double in_cycle = std::fmod(t, 90.0);
    const double speed = std::min({3.0 * in_cycle, 10.0 + std::sin(t),
                                   std::max(0.0, 180.0 - 3.0 * in_cycle)});
    return Odometer{.speed = Rounded(speed, 0.1)};
  })};
  EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 600.0).empty());
}

/// A level stretch of two minutes between hills, in steps of 0.1 m.
TEST(RepeatedReadings, CoarseHeightsRepeatOnTheLevel) {
  Dataset dataset;
  dataset.imu = Imu(100.0);
  dataset.streams = {Readings([](double t) -> MeasurementModel {
    const double hill = t < 200.0 ? t : t < 320.0 ? 200.0 : t - 120.0;
    return HeightFix{Rounded(5.0 * std::sin(0.05 * hill), 0.1)};
  })};
  EXPECT_TRUE(FindRepeatedReadings(dataset, 0.0, 600.0).empty());
}

TEST(RepeatedReadings, HealthySimulatedRecordingsHaveNone) {
  constexpr double kLongest = testing::kSanitized ? 300.0 : 1200.0;  // [s]
  for (const std::string& name : ScenarioNames()) {
    Scenario scenario = FindScenario(name);
    scenario.duration = std::min(scenario.duration, kLongest);
    const Dataset dataset = Simulate(scenario, 3);
    for (const Evidence& evidence :
         FindRepeatedReadings(dataset, 0.0, dataset.imu.t_end())) {
      ADD_FAILURE() << name << ": " << evidence.what;
    }
  }
}

}  // namespace
}  // namespace hindsight
