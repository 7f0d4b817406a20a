#include "dataset/rest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/random.h"
#include "base/units.h"
#include "measurements/sensor_kind.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

constexpr Geodetic kPlace = {0.8, 0.2, 100.0};
constexpr double kDuration = 40.0;  // [s]

/// An IMU at 100 Hz that feels nothing but gravity.
Dataset Quiet() {
  Dataset dataset;
  for (int k = 0; k <= static_cast<int>(100 * kDuration); ++k) {
    dataset.imu.samples.push_back(
        {0.01 * k, {0.0, 0.0, 0.0}, {0.0, 0.0, -kStandardGravity}});
  }
  dataset.imu.noise.accel_noise_density = 1e-3;
  dataset.imu.noise.gyro_noise_density = 1e-4;
  return dataset;
}

using Path = std::function<Eigen::Vector3d(double)>;

/// Position fixes along a path in NED from the origin.
void AddFixes(const Path& path, double period, double sigma, Dataset* dataset) {
  AidingStream stream;
  stream.sensor.name = "gnss";
  Random random(7, 3);
  const Eigen::Matrix3d C_en = NedAxes(kPlace.latitude, kPlace.longitude);
  const int count = static_cast<int>(kDuration / period);
  for (int k = 0; k < count; ++k) {
    const double t = k * period;
    PositionFix fix;
    fix.p_e = EcefFromGeodetic(kPlace) +
              C_en * (path(t) + sigma * random.NormalVector3());
    fix.R_n = sigma * sigma * Eigen::Matrix3d::Identity();
    stream.measurements.push_back(
        {t, static_cast<int>(dataset->streams.size()), false, fix});
  }
  dataset->streams.push_back(stream);
}

Path Standing() {
  return [](double) { return Eigen::Vector3d::Zero(); };
}

/// East at `speed` from t = `departure` on.
Path Leaving(double departure, double speed) {
  return [=](double t) {
    return Eigen::Vector3d(0.0, speed * std::max(0.0, t - departure), 0.0);
  };
}

/// Seconds of the spans inside [begin, end].
double Inside(const std::vector<TimeInterval>& spans, double begin,
              double end) {
  double total = 0.0;
  for (const TimeInterval& span : spans) {
    total +=
        std::max(0.0, std::min(end, span.end) - std::max(begin, span.begin));
  }
  return total;
}

TEST(Rest, AnImuAloneDecidesNothing) {
  const Rest rest = FindRest(Quiet());
  EXPECT_TRUE(rest.at_rest.empty());
  EXPECT_TRUE(rest.moving.empty());
  EXPECT_NEAR(TotalLength(rest.undecided), kDuration, 0.3);
}

TEST(Rest, FixesThatStandShowRestAndFixesThatMoveShowMotion) {
  Dataset dataset = Quiet();
  AddFixes(Leaving(20.0, 10.0), 1.0, 0.5, &dataset);
  const Rest rest = FindRest(dataset);
  // The stretch of fixes over the departure and a second of margin are lost.
  EXPECT_GT(Inside(rest.at_rest, 0.0, 20.0), 10.0);
  EXPECT_EQ(Inside(rest.at_rest, 20.0, kDuration), 0.0);
  EXPECT_GT(Inside(rest.moving, 20.0, kDuration), 19.0);
}

TEST(Rest, AFixEveryFiftySecondsShowsNeither) {
  Dataset dataset = Quiet();
  AddFixes(Leaving(0.0, 5.0), 39.0, 0.5, &dataset);
  dataset.streams[0].measurements.EraseIf(
      [](const Measurement& z) { return z.t > 1.0; });
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
}

TEST(Rest, WithheldFixesShowNothing) {
  Dataset dataset = Quiet();
  AddFixes(Standing(), 1.0, 0.05, &dataset);
  EXPECT_GT(TotalLength(FindRest(dataset).at_rest), 38.0);
  for (Measurement& z : dataset.streams[0].measurements.Edited())
    z.withheld = true;
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
}

TEST(Rest, GoesOnWhileTheImuFeelsNoChangeAndNoLonger) {
  // Fixes for 20 s only; at 30 s something brings the vehicle to speed.
  Dataset dataset = Quiet();
  AddFixes(Standing(), 1.0, 0.02, &dataset);
  dataset.streams[0].measurements.EraseIf(
      [](const Measurement& z) { return z.t > 20.0; });
  const Rest whole = FindRest(dataset);
  EXPECT_GT(Inside(whole.at_rest, 20.0, 30.0), 9.0);
  for (ImuSample& s : dataset.imu.samples) {
    if (s.t > 25.0) s.accel.x() = 0.2;
  }
  const Rest part = FindRest(dataset);
  EXPECT_GT(Inside(part.at_rest, 20.0, 25.0), 4.0);
  // 0.4 m/s after 2 s.
  EXPECT_LT(Inside(part.at_rest, 25.0, kDuration), 2.5);
}

/// Standard deviation of the mean velocity that the zero velocities add.
double MeanVelocitySigma(const Dataset& dataset) {
  double information = 0.0;
  for (const Measurement& z :
       dataset.streams[dataset.streams.size() - 2].measurements) {
    information += std::pow(std::get<ZeroVelocity>(z.model).sigma, -2);
  }
  return 1.0 / std::sqrt(information);
}

TEST(Rest, ASpeedThatNoStretchOfFixesTellsAddsUpToAWay) {
  // 0.5 m/s sigma of neighbours; over 40 s the slope is known to 7 mm/s.
  for (const double speed : {0.08, 0.15, 0.3}) {
    Dataset dataset = Quiet();
    AddFixes(Leaving(0.0, speed), 1.0, 0.5, &dataset);
    EXPECT_TRUE(FindRest(dataset).at_rest.empty()) << speed;
  }
}

TEST(Rest, VelocitiesThatAgreeAddUpToAWay) {
  Dataset dataset = Quiet();
  AidingStream stream;
  Random random(11, 3);
  for (int k = 0; k < 40; ++k) {
    VelocityFix fix;
    fix.v_n = Eigen::Vector3d(0.15, 0.0, 0.0) + 0.1 * random.NormalVector3();
    fix.R_n = 0.01 * Eigen::Matrix3d::Identity();
    stream.measurements.push_back({1.0 * k, 0, false, fix});
  }
  dataset.streams.push_back(stream);
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
}

TEST(Rest, ADepartureThatFixesDoNotTellIsFeltByTheImu) {
  // 0.05 m/s^2 from 20 s on, fixes of 0.5 m.
  Dataset dataset = Quiet();
  for (ImuSample& s : dataset.imu.samples) {
    if (s.t > 20.0) s.accel.y() = 0.05;
  }
  AddFixes(
      [](double t) {
        return Eigen::Vector3d(
            0.0, 0.025 * std::pow(std::max(0.0, t - 20.0), 2), 0.0);
      },
      1.0, 0.5, &dataset);
  const Rest rest = FindRest(dataset);
  EXPECT_GT(Inside(rest.at_rest, 0.0, 20.0), 17.0);
  EXPECT_LT(Inside(rest.at_rest, 20.0, kDuration), 3.0);
}

TEST(RestStreams, AreNoSurerThanTheAidingThatShowsTheRest) {
  for (const double sigma : {0.02, 0.5}) {
    Dataset dataset = Quiet();
    AddFixes(Standing(), 1.0, sigma, &dataset);
    const Rest rest = FindRest(dataset);
    ASSERT_GT(TotalLength(rest.at_rest), 38.0);
    AddRestStreams(rest, &dataset);
    const double slope = sigma * std::sqrt(12.0 / 40.0) / 40.0;
    EXPECT_GE(MeanVelocitySigma(dataset), 0.95 * slope);
    EXPECT_LE(MeanVelocitySigma(dataset), std::max(4.0 * slope, 0.0017));
  }
}

TEST(Rest, VerticalMotionIsMotion) {
  // Lifted by 0.4 m in 5 s, so evenly that the IMU hardly feels it.
  Dataset dataset = Quiet();
  AddFixes(
      [](double t) {
        return Eigen::Vector3d(0.0, 0.0,
                               -0.08 * std::clamp(t - 20.0, 0.0, 5.0));
      },
      0.1, 0.005, &dataset);
  const Rest rest = FindRest(dataset);
  EXPECT_GT(Inside(rest.at_rest, 0.0, 20.0), 17.0);
  EXPECT_LT(Inside(rest.at_rest, 20.5, 24.5), 0.3);
  EXPECT_GT(Inside(rest.at_rest, 25.0, kDuration), 13.0);
}

TEST(Rest, TurningOnTheSpotIsNone) {
  Dataset dataset = Quiet();
  AddFixes(Standing(), 0.1, 0.005, &dataset);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(0.2 * kDegree);
  for (ImuSample& s : dataset.imu.samples) {
    if (s.t > 10.0 && s.t < 30.0) s.gyro.z() = 9.0 * kDegree;
  }
  const Rest rest = FindRest(dataset);
  EXPECT_EQ(Inside(rest.at_rest, 11.0, 29.0), 0.0);
  EXPECT_EQ(Inside(rest.undecided, 11.0, 29.0), 0.0);
  EXPECT_GT(Inside(rest.at_rest, 0.0, 10.0), 9.0);
}

/// Stands for 20 s, then turns on the spot at `rate`, as steadily as a bias.
Rest TurningAt(double rate, double bias_sigma) {
  Dataset dataset = Quiet();
  AddFixes(Standing(), 0.1, 0.005, &dataset);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(bias_sigma);
  for (ImuSample& s : dataset.imu.samples) {
    if (s.t > 20.0) s.gyro.z() = rate;
  }
  return FindRest(dataset);
}

TEST(Rest, ATurnWithinTheBiasContradictsTheRestBefore) {
  const Rest open = TurningAt(2.0 * kDegree, kDegree);
  EXPECT_TRUE(open.at_rest.empty());
  ASSERT_GE(open.turning.size(), 2u);
  for (const TimeInterval& span : open.turning) {
    EXPECT_TRUE(span.end < 20.6 || span.begin > 19.4);
  }
  const Rest told = TurningAt(0.8 * kDegree, 0.2 * kDegree);
  EXPECT_GT(Inside(told.at_rest, 0.0, 20.0), 18.0);
  EXPECT_EQ(Inside(told.at_rest, 20.5, kDuration), 0.0);
  EXPECT_GT(Inside(told.turning, 20.0, kDuration), 17.0);
}

TEST(Rest, GyrosThatWarmUpContradictNone) {
  // A sigma of the bias in the first half minute; shaken from 15 to 25 s.
  Dataset dataset = Quiet();
  AddFixes(Standing(), 0.1, 0.005, &dataset);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(0.5 * kDegree);
  for (ImuSample& s : dataset.imu.samples) {
    s.gyro.z() = std::min(1.0, s.t / 30.0) * 0.5 * kDegree;
    if (s.t > 15.0 && s.t < 25.0) s.gyro.x() += 0.5 * std::sin(20.0 * s.t);
  }
  const Rest rest = FindRest(dataset);
  EXPECT_TRUE(rest.turning.empty());
  EXPECT_GT(Inside(rest.at_rest, 0.0, 15.0), 13.0);
  EXPECT_GT(Inside(rest.at_rest, 25.0, kDuration), kDuration - 28.0);
}

TEST(Rest, ATurnThatTheBiasCannotBeIsNoneHoweverSlow) {
  Dataset dataset = Quiet();
  AddFixes(Standing(), 0.1, 0.005, &dataset);
  dataset.initial.gyro_bias_sigma =
      Eigen::Vector3d::Constant(10.0 * kDegree / 3600.0);
  for (ImuSample& s : dataset.imu.samples) s.gyro.z() = 0.4 * kDegree;
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
}

TEST(Rest, AClimbTooSlowForAnyWindowAddsUpToAWay) {
  // As fast as twice what a rest may sway, for 20 s.
  Dataset dataset = Quiet();
  AddFixes(
      [](double t) {
        return Eigen::Vector3d(0.0, 0.0,
                               -0.02 * std::clamp(t - 10.0, 0.0, 20.0));
      },
      0.1, 0.005, &dataset);
  EXPECT_LT(Inside(FindRest(dataset).at_rest, 12.0, 28.0), 1.0);
}

TEST(Rest, EngineThatIdlesIsSeenByAidingAloneForThreeSeconds) {
  for (const double stop : {2.5, 8.0}) {
    Dataset dataset = Quiet();
    for (ImuSample& s : dataset.imu.samples) {
      s.accel.x() = 0.5 * std::sin(2.0 * kPi * 23.0 * s.t);
    }
    AddFixes(
        [stop](double t) {
          return Eigen::Vector3d(
              0.0, 10.0 * (std::min(t, 15.0) + std::max(0.0, t - 15.0 - stop)),
              0.0);
        },
        0.25, 0.01, &dataset);
    const Rest rest = FindRest(dataset);
    EXPECT_EQ(Inside(rest.at_rest, 0.0, 15.0), 0.0);
    EXPECT_EQ(Inside(rest.at_rest, 15.0 + stop, kDuration), 0.0);
    EXPECT_TRUE(rest.undecided.empty());
    if (stop < 3.0) {
      EXPECT_TRUE(rest.at_rest.empty());
    } else {
      EXPECT_GT(TotalLength(rest.at_rest), stop - 3.5);
    }
  }
}

TEST(Rest, WaterTrackShowsNothing) {
  for (const bool water : {false, true}) {
    Dataset dataset = Quiet();
    AidingStream stream;
    for (int k = 0; k < 40; ++k) {
      Dvl dvl;
      dvl.water = water;
      dvl.sigma.setConstant(0.02);
      dvl.speed.head<3>() = Eigen::Vector3d(k < 20 ? 0.0 : 1.5, 0.0, 0.0);
      stream.measurements.push_back({static_cast<double>(k), 0, false, dvl});
    }
    dataset.streams.push_back(stream);
    const Rest rest = FindRest(dataset);
    if (water) {
      EXPECT_TRUE(rest.at_rest.empty());
      continue;
    }
    EXPECT_GT(Inside(rest.at_rest, 0.0, 20.0), 17.0);
    EXPECT_EQ(Inside(rest.at_rest, 20.0, kDuration), 0.0);
  }
}

TEST(Rest, SpeedsOfAnOdometerCount) {
  for (const double speed : {0.0, 4.0}) {
    Dataset dataset = Quiet();
    AidingStream stream;
    for (int k = 1; k < 40; ++k) {
      Odometer odometer;
      odometer.form = Odometer::Form::kIncrements;
      odometer.distance = speed;
      odometer.t_from = k - 1.0;
      odometer.sigma.setConstant(0.01);
      stream.measurements.push_back(
          {static_cast<double>(k), 0, false, odometer});
    }
    dataset.streams.push_back(stream);
    const Rest rest = FindRest(dataset);
    EXPECT_GT(TotalLength(speed == 0.0 ? rest.at_rest : rest.moving), 38.0);
    EXPECT_EQ(TotalLength(speed == 0.0 ? rest.moving : rest.at_rest), 0.0);
  }
}

TEST(Rest, AGivenVelocityCounts) {
  Dataset dataset = Quiet();
  dataset.initial.v_n = Eigen::Vector3d(0.5, 0.0, 0.0);
  dataset.initial.velocity_sigma = Eigen::Vector3d::Constant(0.05);
  EXPECT_TRUE(FindRest(dataset).at_rest.empty());
  dataset.initial.v_n->setZero();
  const Rest rest = FindRest(dataset);
  ASSERT_EQ(rest.at_rest.size(), 1u);
  EXPECT_EQ(rest.at_rest[0].begin, 0.0);
}

/// Zero velocities at these times, and an IMU that is lively between.
Dataset Flagged(const std::vector<double>& times, double sigma) {
  Dataset dataset;
  dataset.imu = testing::LivelyImu(kDuration, 100.0);
  AidingStream stream;
  stream.sensor.name = "flag";
  stream.sensor.kind = &ZeroVelocityKind();
  for (const double t : times) {
    stream.measurements.push_back({t, 0, false, ZeroVelocity{sigma}});
    for (ImuSample& s : dataset.imu.samples) {
      if (std::abs(s.t - t) > 0.8) continue;
      s.gyro.setZero();
      s.accel = {0.0, 0.0, -kStandardGravity};
    }
  }
  dataset.streams.push_back(stream);
  return dataset;
}

TEST(Rest, ReadingsApartAreNotJoinedOverMotion) {
  std::vector<double> times;
  for (double t = 1.0; t < kDuration - 1.0; t += 2.4) times.push_back(t);
  const Rest rest = FindRest(Flagged(times, 0.05));
  EXPECT_EQ(rest.at_rest.size(), times.size());
  for (const TimeInterval& span : rest.at_rest) EXPECT_LT(span.length(), 1.7);
}

TEST(Rest, FlagsKnownTooBadlyDecideNothing) {
  EXPECT_TRUE(FindRest(Flagged({5.0, 7.4}, 0.3)).at_rest.empty());
}

TEST(Rest, LivelyMotionIsNotEvenUndecided) {
  Dataset dataset;
  dataset.imu = testing::LivelyImu(kDuration, 100.0);
  AddFixes(Standing(), 1.0, 0.5, &dataset);
  const Rest rest = FindRest(dataset);
  EXPECT_TRUE(rest.at_rest.empty());
  EXPECT_TRUE(rest.undecided.empty());
}

TEST(RestStreams, MeasureZeroInEveryWindow) {
  for (const double window : {1.0, 0.15}) {
    Dataset dataset = Quiet();
    dataset.stationary.window = window;
    const Rest rest = {
        .at_rest = {{3.0, 7.0}, {20.0, 20.4}}, .moving = {}, .undecided = {}};
    AddRestStreams(rest, &dataset);
    ASSERT_EQ(dataset.streams.size(), 2u);
    const auto& velocity = dataset.streams[0].measurements;
    const auto& rate = dataset.streams[1].measurements;
    ASSERT_EQ(velocity.size(), window == 1.0 ? 4u : 28u);
    ASSERT_EQ(rate.size(), velocity.size());
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      EXPECT_EQ(velocity[i].sensor, 0);
      EXPECT_EQ(rate[i].sensor, 1);
      EXPECT_EQ(velocity[i].t, rate[i].t);
      EXPECT_TRUE((velocity[i].t > 3.0 && velocity[i].t < 7.0) ||
                  (velocity[i].t > 20.0 && velocity[i].t < 20.4));
    }
  }
}

TEST(RestStreams, AnIncrementBeforeTheSpanIsNoneOfIt) {
  Dataset dataset = Quiet();
  dataset.imu.kind = ImuStream::Kind::kIncrements;
  for (ImuSample& s : dataset.imu.samples) {
    s.accel *= 0.01;
    if (s.t < 10.005) s.gyro.z() = 0.01 * 45.0 * kDegree;
  }
  AddRestStreams({.at_rest = {{10.0, 14.0}}, .moving = {}, .undecided = {}},
                 &dataset);
  const auto& rates = dataset.streams[1].measurements;
  ASSERT_EQ(rates.size(), 4u);
  for (const Measurement& z : rates) {
    EXPECT_NEAR(std::get<ZeroAngularRate>(z.model).w_ib_b.norm(), 0.0, 1e-9);
  }
}

TEST(RestStreams, StraightMotionMeasuresTheRateWhereTheBiasIsKnown) {
  for (const double turn : {0.0, 0.3 * kDegree}) {
    Dataset dataset = Quiet();
    for (ImuSample& s : dataset.imu.samples) {
      s.gyro.x() = 1e-3;
      if (s.t > 10.0) s.gyro.z() = turn;
    }
    const Rest rest = {
        .at_rest = {{2.0, 8.0}}, .moving = {{12.0, 16.0}}, .undecided = {}};
    AddRestStreams(rest, &dataset);
    EXPECT_EQ(dataset.streams[0].measurements.size(), 6u);
    const auto& rates = dataset.streams[1].measurements;
    if (turn > 0.0) {
      EXPECT_EQ(rates.size(), 6u);
      continue;
    }
    ASSERT_EQ(rates.size(), 10u);
    const auto last = std::get<ZeroAngularRate>(rates.back().model);
    EXPECT_NEAR(last.sigma, 2.0 * dataset.stationary.rate_sigma, 1e-12);
    EXPECT_NEAR(last.w_ib_b.x(), 1e-3, 1e-12);
  }
}

TEST(RestStreams, StraightMotionAloneSaysNothingOfTheBias) {
  Dataset dataset = Quiet();
  AddRestStreams({.at_rest = {}, .moving = {{12.0, 16.0}}, .undecided = {}},
                 &dataset);
  EXPECT_TRUE(dataset.streams[1].measurements.empty());
}

/// Of its own data set as it was first asked for, of any other as it is.
TEST(RestMemo, FindsTheRestOfItsOwnDataSetOnce) {
  Dataset standing = Quiet();
  AddFixes(Standing(), 1.0, 0.02, &standing);
  Dataset leaving = Quiet();
  AddFixes(Leaving(20.0, 3.0), 1.0, 0.02, &leaving);
  const RestMemo memo(standing);
  const double stands = TotalLength(memo.Of(standing).at_rest);
  const double leaves = TotalLength(memo.Of(leaving).at_rest);
  EXPECT_EQ(stands, TotalLength(FindRest(standing).at_rest));
  EXPECT_EQ(leaves, TotalLength(FindRest(leaving).at_rest));
  EXPECT_LT(leaves, stands - 5.0);
  standing.imu.samples.resize(2);
  EXPECT_EQ(TotalLength(memo.Of(standing).at_rest), stands);
}

}  // namespace
}  // namespace hindsight
