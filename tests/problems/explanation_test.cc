#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

struct FaultyCase {
  const char* vehicle;
  const char* fault;
  const char* sensor;
  double size;  ///< SI
  const char* says;
};

std::vector<std::string> WhatSpeaksAgainst(const Dataset& dataset) {
  Reconstruction reconstruction(dataset, {});
  std::vector<std::string> all;
  for (const Evidence& evidence : reconstruction.Run("batch").evidence) {
    if (evidence.grade != Grade::kUsable) all.push_back(evidence.what);
  }
  return all;
}

class ExplanationOfFault : public ::testing::TestWithParam<FaultyCase> {};

TEST_P(ExplanationOfFault, NamesIt) {
  const FaultyCase& c = GetParam();
  Dataset dataset = Simulate(FindScenario(c.vehicle, {}), 11);
  ApplyFault({FindFaultKind(c.fault), c.sensor, c.size}, 11, &dataset);
  EXPECT_THAT(WhatSpeaksAgainst(dataset),
              ::testing::Contains(HasSubstr(c.says)));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ExplanationOfFault,
    ::testing::Values(
        FaultyCase{"test_car", "delay", "position", 0.2,
                   "gnss is stamped 0.21 s late"},
        FaultyCase{"test_car", "lever_arm", "position", 1.0,
                   "gnss stands -1 m more forward than its lever arm says"},
        FaultyCase{"test_car", "step", "position", 3.0, "gnss [north] is "},
        FaultyCase{"test_car", "lasting", "position", 1.5,
                   "last longer than the time between its measurements"},
        FaultyCase{"test_aircraft", "imu_rate", "", 2e-4,
                   "s/s faster than all others"},
        FaultyCase{"test_hand", "imu_rate", "", 1e-4,
                   "s/s faster than all others"},
        FaultyCase{"test_aircraft", "gyro_step", "", 3.5e-4,
                   "gyro_bias[z] jumps"},
        FaultyCase{"test_dive", "lasting", "dvl", 0.03, "of dvl"}));

TEST(Explanation, NamesAxesOfTheImuThatAreNotWhatIsSaid) {
  const PerfectRecording hand(FindScenario("test_hand", {}));
  const auto says = [&](const Eigen::Matrix3d& gyro,
                        const Eigen::Matrix3d& accel) {
    Dataset dataset = hand.Realize(11);
    for (ImuSample& sample : dataset.imu.samples) {
      sample.gyro = (gyro * sample.gyro).eval();
      sample.accel = (accel * sample.accel).eval();
    }
    return WhatSpeaksAgainst(dataset);
  };
  const Eigen::Matrix3d right = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d turned =
      Exp(Eigen::Vector3d(0.0, 0.0, 0.05)).toRotationMatrix();
  EXPECT_THAT(says(right, turned),
              ::testing::Contains(HasSubstr("deg about z against the gyros")));
  Eigen::Matrix3d mixed = right;
  mixed.topLeftCorner<2, 2>() << 0.98, 0.02, 0.02, 0.98;
  EXPECT_THAT(says(right, mixed),
              ::testing::Contains(HasSubstr("accelerometer x and y hold ")));
  EXPECT_THAT(says(mixed, right),
              ::testing::Contains(HasSubstr("gyro x and y hold ")));
}

/// Of a hand that swings about its axes, by a filter of the gyros alone.
TEST(Explanation, NamesGyrosThatLagTheAccelerometers) {
  Dataset dataset = Simulate(FindScenario("test_hand", {}), 11);
  auto& samples = dataset.imu.samples;
  constexpr std::size_t kLag = 10;
  for (std::size_t i = samples.size(); i-- > kLag;) {
    samples[i].gyro = samples[i - kLag].gyro;
  }
  EXPECT_THAT(
      WhatSpeaksAgainst(dataset),
      ::testing::Contains(HasSubstr("late against the accelerometers")));
}

/// Fixes of one antenna, and from half time on those of one a metre before it,
/// with the same errors.
TEST(Explanation, NamesAnAntennaThatIsMoved) {
  Scenario scenario = FindScenario("short_drive", {});
  for (unsigned seed = 501; seed < 504; ++seed) {
    Dataset dataset = Simulate(scenario, seed);
    Scenario moved = scenario;
    moved.aiding.front().sensor.lever_arm_b.x() += 1.0;
    const Dataset after = Simulate(moved, seed);
    auto other = after.streams.front().measurements.begin();
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      if (z.t > 90.0) z = *other;
      ++other;
    }
    EXPECT_THAT(WhatSpeaksAgainst(dataset),
                ::testing::Contains(
                    HasSubstr("m more forward than its lever arm says from 9")))
        << seed;
  }
}

/// Where two agree that the place is another it is no matter of either.
TEST(Explanation, NamesAJumpThatAllReceiversHaveInCommon) {
  for (unsigned seed = 511; seed < 514; ++seed) {
    Dataset dataset = Simulate(FindScenario("two_receivers", {}), seed);
    EXPECT_THAT(WhatSpeaksAgainst(dataset), ::testing::IsEmpty()) << seed;
    for (AidingStream& stream : dataset.streams) {
      for (Measurement& z : stream.measurements.Edited()) {
        auto* fix = std::get_if<PositionFix>(&z.model);
        if (fix == nullptr || z.t < 75.0) continue;
        fix->p_e += 3.0 * NedAxes(fix->p_e).col(0);
      }
    }
    EXPECT_THAT(WhatSpeaksAgainst(dataset),
                ::testing::Contains(HasSubstr("position[north] jumps by ")))
        << seed;
  }
}

/// Positions of 2 cm that are said to be good to 3 m: accelerometers that are
/// turned by 1.1 deg, which move the solution, are found by what the innovations
/// say; where nothing is wrong nothing is.
TEST(Explanation, SigmasThatAreTooLargeHideNothing) {
  const PerfectRecording hand(FindScenario("test_hand", {}));
  const Fault overstated = {FindFaultKind("sigma"), "position", 150.0};
  const Eigen::Matrix3d turned =
      Exp(Eigen::Vector3d(0.0, 0.0, 0.02)).toRotationMatrix();
  for (unsigned seed = 11; seed < 13; ++seed) {
    Dataset dataset = hand.Realize(seed);
    ApplyFault(overstated, seed, &dataset);
    EXPECT_THAT(WhatSpeaksAgainst(dataset), ::testing::IsEmpty()) << seed;
    for (ImuSample& sample : dataset.imu.samples) {
      sample.accel = (turned * sample.accel).eval();
    }
    EXPECT_THAT(
        WhatSpeaksAgainst(dataset),
        ::testing::Contains(HasSubstr("if sigmas were what the innovations "
                                      "say")))
        << seed;
  }
}

/// Errors that last in what a receiver measures, stated as they are.
struct LastingErrors {
  bool of_velocities;
  double sigma;  ///< an axis [m or m/s]
  double tau;    ///< [s]
};

/// A drone with such errors, whose fixes, positions from the first one on, are
/// multiplied.
Dataset DroneWith(const LastingErrors& errors, double factor, unsigned seed) {
  Dataset dataset = Simulate(
      FindScenario("test_drone", {"aiding.gnss.sigma=0.1 m",
                                  "aiding.gnss_velocity.sigma=0.05 m/s",
                                  "aiding.gnss_velocity.rate=2 Hz"}),
      seed);
  Random random(seed, 7);
  for (AidingStream& stream : dataset.streams) {
    const SensorKind& kind = *stream.sensor.kind;
    if (errors.of_velocities ? !kind.is_velocity : !kind.is_position) continue;
    NoiseModel& noise = stream.sensor.noise;
    noise.kind = &GaussMarkovNoise();
    noise.sigma = errors.sigma;
    noise.tau = errors.tau;
    Eigen::Vector3d e = errors.sigma * random.NormalVector3();
    std::optional<Eigen::Vector3d> first_e;
    double before = stream.measurements.front().t;
    for (Measurement& z : stream.measurements.Edited()) {
      const double kept = std::exp(-(z.t - before) / errors.tau);
      e = kept * e +
          std::sqrt(1.0 - kept * kept) * errors.sigma * random.NormalVector3();
      before = z.t;
      if (auto* fix = std::get_if<PositionFix>(&z.model)) {
        if (!first_e) first_e = fix->p_e;
        fix->p_e = *first_e + factor * (fix->p_e - *first_e);
        fix->p_e += NedAxes(fix->p_e) * e;
        noise.white_sigma = std::sqrt(fix->R_n(0, 0));
      } else if (auto* velocity = std::get_if<VelocityFix>(&z.model)) {
        velocity->v_n = factor * velocity->v_n + e;
        noise.white_sigma = std::sqrt(velocity->R_n(0, 0));
      }
    }
  }
  return dataset;
}

class ExplanationBesideLastingErrors
    : public ::testing::TestWithParam<LastingErrors> {};

TEST_P(ExplanationBesideLastingErrors, TakesThemForNoScale) {
  for (unsigned seed = 31; seed < 36; ++seed) {
    EXPECT_THAT(WhatSpeaksAgainst(DroneWith(GetParam(), 1.0, seed)),
                ::testing::Not(::testing::Contains(HasSubstr(" measures is "))))
        << seed;
    EXPECT_THAT(WhatSpeaksAgainst(DroneWith(GetParam(), 1.15, seed)),
                ::testing::Contains(::testing::AllOf(HasSubstr(" measures is "),
                                                     HasSubstr(" too large"))))
        << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, ExplanationBesideLastingErrors,
                         ::testing::Values(LastingErrors{true, 0.3, 30.0},
                                           LastingErrors{true, 0.3, 5.0},
                                           LastingErrors{false, 0.7, 60.0},
                                           LastingErrors{false, 0.7, 10.0}));

TEST(Explanation, AHealthyRecordingNeedsNone) {
  const int seeds = testing::SeedCount(25, 100);
  int doubted = 0;
  for (const char* vehicle :
       {"test_car", "test_aircraft", "test_dive", "test_hand"}) {
    const PerfectRecording perfect(FindScenario(vehicle, {}));
    for (int seed = 0; seed < seeds; ++seed) {
      if (!WhatSpeaksAgainst(
               perfect.Realize(4000 + static_cast<unsigned>(seed)))
               .empty()) {
        ++doubted;
      }
    }
  }
  // Asked: 97 % usable.
  EXPECT_LE(doubted, 4 * seeds * 3 / 100);
}

}  // namespace
}  // namespace hindsight
