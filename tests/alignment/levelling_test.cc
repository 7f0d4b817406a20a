#include "alignment/levelling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/alignment.h"
#include "alignment/gyrocompass.h"
#include "alignment/start.h"
#include "base/chi_square.h"
#include "base/error.h"
#include "base/random.h"
#include "io/config/scenario_config.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// A vehicle that stands for two minutes, with an IMU of the given grade.
Scenario LevelAndStill(double gyro_bias, double accel_bias) {
  Scenario s = FindScenario("short_drive");
  s.start_heading = 200.0 * kDegree;
  s.segments = {Segment::Stop(120.0)};
  s.duration = 120.0;
  s.imu.gyro_bias_sigma.setConstant(gyro_bias);
  s.imu.accel_bias_sigma.setConstant(accel_bias);
  s.imu.noise.gyro_noise_density = 0.002 * kDegreePerSqrtHour;
  return s;
}

constexpr double kNavigationGyro = 0.01 * kDegree / kHour;
constexpr double kNavigationAccel = 50e-6 * kStandardGravity;

TEST(Gyrocompass, FindsTheHeadingWithItsOwnCovariance) {
  const PerfectRecording recording(
      LevelAndStill(kNavigationGyro, kNavigationAccel));
  constexpr int kRuns = testing::SeedCount(60);
  double nees = 0.0;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Dataset dataset = recording.Realize(seed);
    const Start start = FindStart(dataset, 0.0, 120.0);
    ASSERT_EQ(start.report.alignment, "gyrocompass") << start.report.why;
    const double error =
        WrapAngle(EulerFromQuaternion(*dataset.truth.front().q_nb).z() -
                  start.report.state.euler().z());
    const double sigma = start.report.attitude_sigma.z();
    EXPECT_LT(sigma, 0.2 * kDegree);
    nees += std::pow(error / sigma, 2) / kRuns;
    square += error * error / kRuns;
  }
  EXPECT_TRUE(AneesBounds(kRuns, 1, 0.999).Contains(nees)) << nees;
  EXPECT_LT(std::sqrt(square), 0.15 * kDegree);
}

TEST(Gyrocompass, SaysThatAWorseGyroDoesNotTellTheHeading) {
  const Dataset dataset = Simulate(
      LevelAndStill(20.0 * kDegree / kHour, 1e-3 * kStandardGravity), 1);
  const Start start = FindStart(dataset, 0.0, 120.0);
  EXPECT_EQ(start.report.alignment, "static");
  EXPECT_NE(start.report.why.find("gyrocompass: the gyros would give"),
            std::string::npos)
      << start.report.why;
  EXPECT_GE(start.prior.P(8, 8), kUnknownHeadingSigma * kUnknownHeadingSigma);
}

TEST(Gyrocompass, SaysWhatToDoWhereTheGyrosAreTooNoisy) {
  Scenario scenario = LevelAndStill(0.1 * kDegree, 1e-3 * kStandardGravity);
  scenario.imu.noise.gyro_noise_density = 5.0 * kDegreePerSqrtHour;
  const Start start = FindStart(Simulate(scenario, 1), 0.0, 120.0);
  EXPECT_NE(start.report.why.find("too noisy to find north"), std::string::npos)
      << start.report.why;
  EXPECT_NE(start.report.why.find("give initial.attitude"), std::string::npos);
}

TEST(Alignment, TheMethodAskedForIsTakenOrSaysWhyNot) {
  Dataset dataset =
      Simulate(LevelAndStill(kNavigationGyro, kNavigationAccel), 1);
  dataset.initial.alignment = AlignmentKind::kStatic;
  EXPECT_EQ(FindStart(dataset, 0.0, 120.0).report.alignment, "static");
  dataset.initial.alignment = AlignmentKind::kCourse;
  try {
    FindStart(dataset, 0.0, 120.0);
    FAIL();
  } catch (const EstimationError& error) {
    EXPECT_STREQ(error.what(), "alignment course: no motion above 3 m/s");
  }
}

TEST(Alignment, EveryMethodHasAName) {
  for (const AlignmentMethod& method : AlignmentMethods()) {
    EXPECT_FALSE(AlignmentName(method.kind).empty());
  }
  EXPECT_EQ(AlignmentName(AlignmentKind::kAhrs), "ahrs");
}

/// Gyros at rest for 40 s whose biases drift evenly, by `drift` in all.
Dataset DriftingAtRest(const Eigen::Vector3d& drift, std::uint64_t seed) {
  constexpr double kDt = 0.01;
  constexpr int kSamples = 4001;
  Dataset dataset;
  dataset.imu.noise.gyro_noise_density = 0.01 * kDegree;
  dataset.imu.nominal_dt = kDt;
  Random random(seed, 0);
  for (int k = 0; k < kSamples; ++k) {
    const Eigen::Vector3d noise = dataset.imu.noise.gyro_noise_density /
                                  std::sqrt(kDt) * random.NormalVector3();
    dataset.imu.samples.push_back({k * kDt,
                                   k / (kSamples - 1.0) * drift + noise,
                                   Eigen::Vector3d::Zero()});
  }
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(0.5 * kDegree);
  return dataset;
}

TEST(GyroBias, AfterARestIsThatOfItsEnd) {
  const TimeInterval rest{0.0, 40.0};
  const Eigen::Vector3d drift = kDegree * Eigen::Vector3d(0.6, -0.3, 0.0);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Dataset drifting = DriftingAtRest(drift, seed);
    EXPECT_GT(DriftAtRest(drifting.imu, rest), 0.25 * kDegree);
    const GyroBiasPrior end = GyroBiasAfterRest(drifting, rest);
    EXPECT_LT((end.b_g - drift).cwiseQuotient(end.sigma).cwiseAbs().maxCoeff(),
              4.0)
        << seed;
    EXPECT_LT(end.sigma.maxCoeff(), 0.1 * kDegree);
    EXPECT_LT(end.sigma.maxCoeff(),
              0.5 * GyroBiasAtRest(drifting, rest).sigma.maxCoeff());

    const Dataset steady = DriftingAtRest(none, seed);
    if (DriftAtRest(steady.imu, rest) > 0.0) continue;  // once in a hundred
    EXPECT_EQ(GyroBiasAfterRest(steady, rest).b_g,
              GyroBiasAtRest(steady, rest).b_g);
  }
}

}  // namespace
}  // namespace hindsight
