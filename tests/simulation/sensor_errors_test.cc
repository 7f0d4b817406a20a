#include "simulation/sensor_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// 99.99 % bounds of the mean square of n standard normal deviates (normal
/// approximation of chi-square / n, n large).
void ExpectUnitVariance(double mean_square, double n) {
  const double bound = 3.89 * std::sqrt(2.0 / n);
  EXPECT_NEAR(mean_square, 1.0, bound);
}

class ImuNoiseTest : public testing::TestWithParam<ImuStream::Kind> {};

TEST_P(ImuNoiseTest, WhiteNoiseHasTheStatedDensity) {
  ImuErrorModel model;
  model.noise.gyro_noise_density = 3e-5;
  model.noise.accel_noise_density = 8e-4;
  const double rate_hz = 125.0;
  ImuErrors errors(model, GetParam(), rate_hz, 11);
  const int n = 40000;
  const int per_second = 125;
  double gyro = 0.0;
  double accel = 0.0;
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  double integral = 0.0;
  for (int k = 0; k < n; ++k) {
    ImuSample sample;
    errors.Apply(&sample);
    const double to_rate =
        GetParam() == ImuStream::Kind::kRates ? 1.0 : rate_hz;
    gyro += (to_rate * sample.gyro).squaredNorm();
    accel += (to_rate * sample.accel).squaredNorm();
    angle += to_rate * sample.gyro / rate_hz;
    if ((k + 1) % per_second == 0) {
      integral += angle.squaredNorm();
      angle.setZero();
    }
  }
  // Variance of a rate: density^2 rate; of its integral over 1 s: density^2.
  ExpectUnitVariance(gyro / (3 * n * 3e-5 * 3e-5 * rate_hz), 3.0 * n);
  ExpectUnitVariance(accel / (3 * n * 8e-4 * 8e-4 * rate_hz), 3.0 * n);
  const double seconds = static_cast<double>(n) / per_second;
  ExpectUnitVariance(integral / (3 * seconds * 3e-5 * 3e-5), 3.0 * seconds);
}

TEST_P(ImuNoiseTest, BiasScaleAndRateNoiseEnterAsStated) {
  ImuErrorModel model;
  model.gyro_bias = {1e-3, -2e-3, 3e-3};
  model.accel_bias = {0.1, 0.2, -0.3};
  model.gyro_scale = {0.01, 0.0, -0.02};
  model.accel_scale = {0.0, 0.05, 0.0};
  ImuErrors errors(model, GetParam(), 100.0, 1);
  const double dt = GetParam() == ImuStream::Kind::kRates ? 1.0 : 0.01;
  ImuSample sample;
  sample.gyro = dt * Eigen::Vector3d(1.0, 2.0, 3.0);
  sample.accel = dt * Eigen::Vector3d(4.0, 5.0, 6.0);
  errors.Apply(&sample);
  const Eigen::Vector3d gyro(1.011, 1.998, 2.943);
  const Eigen::Vector3d accel(4.1, 5.45, 5.7);
  EXPECT_LT((sample.gyro / dt - gyro).norm(), 1e-14);
  EXPECT_LT((sample.accel / dt - accel).norm(), 1e-14);
}

TEST_P(ImuNoiseTest, NoisePerRateGrowsWithTheRate) {
  ImuErrorModel model;
  model.noise.gyro_noise_density = 3e-5;
  model.noise.gyro_noise_per_rate = 4e-5;
  const double rate_hz = 100.0;
  const double dt = GetParam() == ImuStream::Kind::kRates ? 1.0 : 0.01;
  ImuErrors errors(model, GetParam(), rate_hz, 5);
  const int n = 20000;
  double sum = 0.0;
  const Eigen::Vector3d rate(0.0, 1.0, 0.0);
  for (int k = 0; k < n; ++k) {
    ImuSample sample;
    sample.gyro = dt * rate;
    errors.Apply(&sample);
    sum += (sample.gyro / dt - rate).squaredNorm();
  }
  ExpectUnitVariance(sum / (3 * n * 5e-5 * 5e-5 * rate_hz), 3.0 * n);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ImuNoiseTest,
                         testing::Values(ImuStream::Kind::kRates,
                                         ImuStream::Kind::kIncrements));

TEST(ImuErrors, StartBiasHasTheStatedSigma) {
  ImuErrorModel model;
  model.gyro_bias_sigma = {1e-5, 2e-5, 3e-5};
  model.accel_bias_sigma = {0.01, 0.02, 0.03};
  const int n = 3000;
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();
  for (int seed = 0; seed < n; ++seed) {
    const ImuErrors errors(model, ImuStream::Kind::kRates, 100.0,
                           static_cast<std::uint64_t>(seed));
    gyro += errors.gyro_bias().cwiseAbs2();
    accel += errors.accel_bias().cwiseAbs2();
  }
  for (int axis = 0; axis < 3; ++axis) {
    ExpectUnitVariance(
        gyro(axis) / (n * std::pow(model.gyro_bias_sigma(axis), 2)), n);
    ExpectUnitVariance(
        accel(axis) / (n * std::pow(model.accel_bias_sigma(axis), 2)), n);
  }
}

TEST(ImuErrors, BiasWalkGrowsWithTheSquareRootOfTime) {
  ImuErrorModel model;
  model.noise.gyro_bias_walk = 2e-6;
  model.noise.accel_bias_walk = 3e-5;
  const int n = 2000;
  const int steps = 100;  // 10 s
  double gyro = 0.0;
  double accel = 0.0;
  for (int seed = 0; seed < n; ++seed) {
    ImuErrors errors(model, ImuStream::Kind::kIncrements, 10.0,
                     static_cast<std::uint64_t>(seed));
    ImuSample sample;
    for (int k = 0; k <= steps; ++k) errors.Apply(&sample);
    gyro += errors.gyro_bias().squaredNorm();
    accel += errors.accel_bias().squaredNorm();
  }
  ExpectUnitVariance(gyro / (3.0 * n * 4e-12 * 10.0), 3.0 * n);
  ExpectUnitVariance(accel / (3.0 * n * 9e-10 * 10.0), 3.0 * n);
}

TEST(ImuErrors, GaussMarkovBiasIsStationary) {
  const double tau = 2.0;
  const double sigma = 1e-4;
  ImuErrorModel model;
  model.noise.gyro_bias_tau = tau;
  model.noise.gyro_bias_walk = std::sqrt(2.0 / tau) * sigma;
  model.gyro_bias_sigma.setConstant(sigma);
  const int n = 2000;
  double late = 0.0;
  double product = 0.0;
  for (int seed = 0; seed < n; ++seed) {
    ImuErrors errors(model, ImuStream::Kind::kRates, 10.0,
                     static_cast<std::uint64_t>(seed));
    const Eigen::Vector3d early = errors.gyro_bias();
    ImuSample sample;
    for (int k = 0; k <= 20; ++k) errors.Apply(&sample);
    late += errors.gyro_bias().squaredNorm();
    product += early.dot(errors.gyro_bias());
  }
  const double unit = 3.0 * n * sigma * sigma;
  ExpectUnitVariance(late / unit, 3.0 * n);
  // Correlation exp(-2 s/tau), standard error sqrt((1 + rho^2)/n).
  EXPECT_NEAR(product / unit, std::exp(-1.0),
              3.89 * std::sqrt(1.14 / (3.0 * n)));
}

TEST(ImuErrors, ChangingOneSensorLeavesTheOthersDeviatesAlone) {
  ImuErrorModel plain;
  plain.noise.accel_noise_density = 1e-3;
  ImuErrorModel more = plain;
  more.noise.gyro_noise_density = 1e-4;
  more.noise.gyro_bias_walk = 1e-5;
  more.gyro_bias_sigma.setConstant(1e-3);
  ImuErrors a(plain, ImuStream::Kind::kRates, 100.0, 9);
  ImuErrors b(more, ImuStream::Kind::kRates, 100.0, 9);
  for (int k = 0; k < 100; ++k) {
    ImuSample x;
    ImuSample y;
    a.Apply(&x);
    b.Apply(&y);
    EXPECT_EQ(x.accel, y.accel);
    EXPECT_NE(x.gyro, y.gyro);
  }
}

/// Heading east from (0, 0, 0): forward = +y of ECEF, right = -z, down = -x.
SegmentTrajectory EastOnTheEquator() {
  return SegmentTrajectory(
      {0.0, 0.0, 0.0},
      MotionProfile({Segment::Straight(10.0)}, 20.0, 90.0 * kDegree), 100.0);
}

AidingModel Model(const SensorKind& kind) {
  AidingModel model(kind);
  model.sensor.name = "sensor";
  model.sensor.lever_arm_b = {2.0, 0.5, -1.5};
  model.sigma = Eigen::Vector3d(0.1, 0.2, 0.3);
  return model;
}

TEST(PerfectMeasurements, SeeTheSensorsPoint) {
  SegmentTrajectory trajectory = EastOnTheEquator();
  const auto positions =
      PerfectMeasurements(Model(PositionKind()), 4, &trajectory, 10.0);
  ASSERT_EQ(positions.size(), 11U);
  EXPECT_EQ(positions[3].t, 3.0);
  EXPECT_EQ(positions[3].sensor, 4);
  const auto& fix = std::get<PositionFix>(positions.front().model);
  EXPECT_LT(
      (fix.p_e - Eigen::Vector3d(kEarthSemiMajorAxis + 1.5, 2.0, -0.5)).norm(),
      1e-8);
  EXPECT_LT((fix.R_n.diagonal() - Eigen::Vector3d(0.01, 0.04, 0.09)).norm(),
            1e-15);
  const auto heights =
      PerfectMeasurements(Model(HeightKind()), 0, &trajectory, 10.0);
  const auto& height = std::get<HeightFix>(heights.front().model);
  // 2 m east of the foot point the ellipsoid has dropped by 0.3 um.
  EXPECT_NEAR(height.height, 1.5, 1e-6);
  EXPECT_EQ(height.sigma, 0.3);
}

TEST(PerfectMeasurements, VelocityHasTheLeverArmsPart) {
  SegmentTrajectory turning(
      {0.8, 0.2, 0.0},
      MotionProfile({Segment::Turn(90.0 * kDegree, 0.2)}, 10.0, 0.0), 100.0);
  AidingModel model = Model(VelocityKind());
  model.rate_hz = 0.25;
  const auto fixes = PerfectMeasurements(model, 0, &turning, 8.0);
  const Motion m = turning.At(4.0);
  // At full rate: w = 0.2 rad/s down, so w x l = 0.2 (-0.5, 2, 0) in body axes.
  const Eigen::Vector3d v_b(10.0 - 0.1, 0.4, 0.0);
  const Eigen::Vector3d expected = NedAxes(m.p_e).transpose() * (m.q_eb * v_b);
  const auto& fix = std::get<VelocityFix>(fixes[1].model);
  EXPECT_EQ(fixes[1].t, 4.0);
  // What is left is the turn of the level axes, v/R l = 5e-6 m/s.
  EXPECT_LT((fix.v_n - expected).norm(), 6e-6);
}

TEST(PerfectMeasurements, TimeOffsetMovesTheMotionNotTheStamp) {
  SegmentTrajectory trajectory = EastOnTheEquator();
  AidingModel model = Model(PositionKind());
  model.sensor.time_offset = 0.125;
  const auto late = PerfectMeasurements(model, 0, &trajectory, 10.0);
  ASSERT_EQ(late.size(), 10U);  // a stamp of 10 s would be true at 10.125 s
  EXPECT_EQ(late.front().t, 0.0);
  EXPECT_NEAR(std::get<PositionFix>(late.front().model).p_e.y(),
              2.0 + 20.0 * 0.125, 1e-5);
  model.sensor.time_offset = -0.125;
  const auto early = PerfectMeasurements(model, 0, &trajectory, 10.0);
  ASSERT_EQ(early.size(), 10U);  // a stamp of 0 would be true before the start
  EXPECT_EQ(early.front().t, 1.0);
}

TEST(PerfectMeasurements, StopAtTheirSpanAndPauseInOutages) {
  SegmentTrajectory trajectory = EastOnTheEquator();
  AidingModel model = Model(PositionKind());
  model.rate_hz = 2.0;
  model.from = 1.9;
  model.to = 8.0;
  model.outages = {{3.0, 4.0}, {6.5, 7.0}};
  std::vector<double> stamps;
  for (const auto& z : PerfectMeasurements(model, 0, &trajectory, 10.0)) {
    stamps.push_back(z.t);
  }
  EXPECT_EQ(stamps, (std::vector<double>{2.0, 2.5, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0,
                                         7.5, 8.0}));
}

TEST(MeasurementErrors, HaveTheStatedSigmaInNorthEastDown) {
  SegmentTrajectory trajectory(
      {0.8, 0.2, 0.0}, MotionProfile({Segment::Straight(3000.0)}, 5.0, 0.4),
      1.0);
  const AidingModel model = Model(PositionKind());
  const auto perfect = PerfectMeasurements(model, 0, &trajectory, 3000.0);
  auto measured = perfect;
  AddMeasurementErrors(model, 3, {}, &measured);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < perfect.size(); ++k) {
    const auto& truth = std::get<PositionFix>(perfect[k].model).p_e;
    const auto& fix = std::get<PositionFix>(measured[k].model).p_e;
    sum += (NedAxes(truth).transpose() * (fix - truth)).cwiseAbs2();
  }
  const double n = static_cast<double>(perfect.size());
  for (int axis = 0; axis < 3; ++axis) {
    ExpectUnitVariance(sum(axis) / (n * std::pow((*model.sigma)(axis), 2)), n);
  }
}

}  // namespace
}  // namespace hindsight
