#include "dataset/ground_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr Geodetic kOrigin = {0.8, 0.2, 100.0};

/// A vehicle that stands until `departure` and then goes east at `speed`; its
/// IMU feels nothing of it.
Dataset Cruise(double departure, double speed, double sigma) {
  Dataset dataset;
  for (int k = 0; k <= 2000; ++k) {
    dataset.imu.samples.push_back(
        {0.01 * k, {0.0, 0.0, 0.0}, {0.0, 0.0, -kStandardGravity}});
  }
  AidingStream stream;
  stream.sensor.name = "gnss";
  stream.sensor.time_offset = 0.1;
  const Eigen::Matrix3d C_en = NedAxes(kOrigin.latitude, kOrigin.longitude);
  for (int k = 0; k < 20; ++k) {
    const double path = speed * std::max(0.0, k + 0.1 - departure);
    PositionFix fix;
    fix.p_e = EcefFromGeodetic(kOrigin) + C_en.col(1) * path;
    fix.R_n = sigma * sigma * Eigen::Matrix3d::Identity();
    stream.measurements.push_back({static_cast<double>(k), 0, k == 5, fix});
  }
  dataset.streams.push_back(stream);
  return dataset;
}

TEST(GroundMotion, FixesComeAtTrueTimesWithoutWithheldOnes) {
  const Dataset dataset = Cruise(0.0, 10.0, 0.05);
  const std::vector<TimedFix> fixes = PositionFixes(dataset, 3.0, 8.0);
  ASSERT_EQ(fixes.size(), 4u);  // 3.1, 4.1, 6.1, 7.1
  EXPECT_DOUBLE_EQ(fixes[0].t, 3.1);
  EXPECT_DOUBLE_EQ(fixes[2].t, 6.1);
  EXPECT_NEAR(fixes[0].sigma, 0.05, 1e-15);
}

TEST(GroundMotion, VelocityFromDifferencesOfFixes) {
  const Dataset dataset = Cruise(0.0, 10.0, 0.05);
  const std::vector<TimedVelocity> velocities =
      GroundVelocities(dataset, 0.0, 20.0);
  ASSERT_FALSE(velocities.empty());
  for (const TimedVelocity& v : velocities) {
    // NED axes turn by 200 m/R along the way.
    EXPECT_LT((v.v_n - Eigen::Vector3d(0.0, 10.0, 0.0)).norm(), 1e-3);
    EXPECT_GT(v.sigma, 0.0);
    EXPECT_LT(v.sigma, 0.3);
  }
}

TEST(GroundMotion, MeasuredVelocitiesTakePrecedence) {
  Dataset dataset = Cruise(0.0, 10.0, 0.05);
  AidingStream stream;
  stream.sensor.name = "doppler";
  VelocityFix fix;
  fix.v_n = {1.0, 2.0, 3.0};
  fix.R_n *= 0.04;
  stream.measurements.push_back({4.0, 1, false, fix});
  dataset.streams.push_back(stream);
  const std::vector<TimedVelocity> velocities =
      GroundVelocities(dataset, 0.0, 20.0);
  ASSERT_EQ(velocities.size(), 1u);
  EXPECT_EQ(velocities[0].v_n, fix.v_n);
  EXPECT_NEAR(velocities[0].sigma, 0.2, 1e-15);
}

TEST(GroundMotion, BottomVelocityFromTheBeamsThatWereReceived) {
  for (const bool water : {false, true}) {
    Dataset dataset;
    AidingStream stream;
    const Eigen::Vector3d v_d(1.5, 0.2, 0.1);
    for (int k = 0; k < 20; ++k) {
      Dvl dvl;
      dvl.form = Dvl::Form::kBeams;
      dvl.beam_angle = 30.0 * kDegree;
      dvl.valid[static_cast<std::size_t>(k % 4)] = false;
      dvl.water = water;
      dvl.sigma.setConstant(0.02);
      for (int i = 0; i < 4; ++i) dvl.speed(i) = dvl.Direction(i).dot(v_d);
      stream.measurements.push_back({static_cast<double>(k), 0, false, dvl});
    }
    dataset.streams.push_back(stream);
    const std::vector<BottomVelocity> velocities =
        BottomVelocities(dataset, 0.0, 20.0);
    if (water) {
      // Speed through the water is none over the ground.
      EXPECT_TRUE(velocities.empty());
      continue;
    }
    ASSERT_EQ(velocities.size(), 20u);
    EXPECT_LT((velocities[15].v_b - v_d).norm(), 1e-12);
    EXPECT_NEAR(velocities[0].sigma, 0.02 / std::sqrt(0.5), 1e-12);
  }
}

TEST(GroundMotion, TwoBeamsAreNoVelocity) {
  Dataset dataset;
  AidingStream stream;
  Dvl dvl;
  dvl.form = Dvl::Form::kBeams;
  dvl.beam_angle = 30.0 * kDegree;
  dvl.valid = {true, false, true, false};
  stream.measurements.push_back({1.0, 0, false, dvl});
  dataset.streams.push_back(stream);
  EXPECT_TRUE(BottomVelocities(dataset, 0.0, 2.0).empty());
}

}  // namespace
}  // namespace hindsight
