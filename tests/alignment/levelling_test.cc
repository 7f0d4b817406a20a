#include "alignment/levelling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/alignment.h"
#include "alignment/gyrocompass.h"
#include "alignment/start.h"
#include "base/error.h"
#include "evaluation/chi_square.h"
#include "simulation/builtin_scenarios.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// A vehicle that stands for two minutes, with an IMU of the given grade.
Scenario Standing(double gyro_bias, double accel_bias) {
  Scenario s = BuiltinScenario("short_drive");
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
  const PerfectRecording recording(Standing(kNavigationGyro, kNavigationAccel));
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
  const Dataset dataset =
      Simulate(Standing(20.0 * kDegree / kHour, 1e-3 * kStandardGravity), 1);
  const Start start = FindStart(dataset, 0.0, 120.0);
  EXPECT_EQ(start.report.alignment, "static");
  EXPECT_NE(start.report.why.find("gyrocompass: the gyros would give"),
            std::string::npos)
      << start.report.why;
  EXPECT_GE(start.prior.P(8, 8), kUnknownHeadingSigma * kUnknownHeadingSigma);
}

TEST(Alignment, TheMethodAskedForIsTakenOrSaysWhyNot) {
  Dataset dataset = Simulate(Standing(kNavigationGyro, kNavigationAccel), 1);
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

TEST(MeanReading, IsTheMeanOfAllReadings) {
  const Dataset dataset =
      Simulate(Standing(kNavigationGyro, kNavigationAccel), 2);
  const Kinematics mean = MeanReading(dataset.imu, 10.0, 60.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : dataset.imu.samples) {
    if (sample.t > 10.0 + 1e-9 && sample.t < 60.0 + 1e-9) sum += sample.accel;
  }
  EXPECT_LT((mean.f_b - sum / 50.0).norm(), 1e-4);
}

}  // namespace
}  // namespace hindsight
