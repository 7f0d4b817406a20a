#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "alignment/gyro_drift.h"
#include "alignment/start.h"
#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "simulation/wandering_drive.h"
#include "support/in_flight.h"
#include "support/seed_count.h"
#include "support/truth_at.h"

namespace hindsight {
namespace {

constexpr double kWarmUp = 60.0;          // [s]
constexpr double kDrift = 1.0 * kDegree;  // [rad/s] over the warm-up
constexpr std::uint64_t kStream = 500;    // of the deviates

/// A consumer's IMU, which says nothing of its warm-up.
void UseConsumerImu(Scenario* scenario) {
  scenario->imu.noise.gyro_noise_density = 0.01 * kDegree;
  scenario->imu.noise.accel_noise_density = 200.0 * kMicroG;
  scenario->imu.noise.gyro_bias_walk = 1e-4 * kDegree;
  scenario->imu.noise.accel_bias_walk = 1e-4;
  scenario->imu.gyro_bias_sigma.setConstant(0.3 * kDegree);
  scenario->imu.accel_bias_sigma.setConstant(10.0 * kMilliG);
  scenario->start_errors.reset();
}

AidingModel Gnss(const SensorKind& kind, double sigma, double rate) {
  AidingModel model(kind);
  model.sensor.name = kind.is_position ? "gnss" : "velocity";
  model.sigma = Eigen::Vector3d(sigma, sigma, 2.0 * sigma);
  model.rate_hz = rate;
  return model;
}

/// A car that stands for `rest` seconds or moves from the beginning.
Scenario Car(double rest, std::uint64_t route, bool with_velocity) {
  Scenario s = FindScenario("short_drive");
  s.duration = 150.0;
  s.segments = WanderingDrive(s.duration, route);
  if (rest > 0.0) {
    s.segments.front() = Segment::Stop(rest);
  } else {
    s.start_speed = 9.0;
    s.segments.erase(s.segments.begin());
  }
  s.aiding = {Gnss(PositionKind(), 0.5, with_velocity ? 1.0 : 4.0)};
  if (with_velocity) {
    s.aiding.push_back(Gnss(VelocityKind(), 0.1, 4.0));
  }
  return s;
}

Scenario Aircraft(double rate) {
  Scenario s = InFlightAlignment(rate);
  s.aiding.push_back(Gnss(PositionKind(), 1.0, 1.0));
  return s;
}

constexpr int kKinds = 6;

Scenario KindOf(std::uint64_t seed) {
  const std::uint64_t route = 1000 + seed;
  switch (seed % kKinds) {
    case 0:
      return Car(20.0, route, true);
    case 1:
      return Car(45.0, route, false);
    case 2:
      return Car(0.0, route, true);
    case 3:
      return Car(0.0, route, false);
    case 4:
      return Aircraft(10.0);
    default:
      return Aircraft(1.0);
  }
}

/// The gyros drift by kDrift over the warm-up, half of the seeds evenly, half
/// as a body that warms up does.
void WarmUp(std::uint64_t seed, Dataset* dataset) {
  Random random(seed, kStream);
  const Eigen::Vector3d drift = kDrift * random.NormalVector3().normalized();
  const double tau = random.Uniform() < 0.5 ? 1e3 * kWarmUp : kWarmUp / 3.0;
  const double whole = -std::expm1(-kWarmUp / tau);
  const auto drifted = [&](double t) -> Eigen::Vector3d {
    return -std::expm1(-std::min(t, kWarmUp) / tau) / whole * drift;
  };
  double before = dataset->imu.samples.front().t;
  const bool rates = dataset->imu.kind == ImuStream::Kind::kRates;
  for (ImuSample& sample : dataset->imu.samples) {
    const double dt = sample.t - before;
    sample.gyro += (rates ? 1.0 : dt) * drifted(sample.t - 0.5 * dt);
    before = sample.t;
  }
}

Dataset Recording(std::uint64_t seed) {
  Scenario scenario = KindOf(seed);
  UseConsumerImu(&scenario);
  Dataset dataset = Simulate(scenario, seed);
  MountAnywhere(seed, &dataset);
  WarmUp(seed, &dataset);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(0.5 * kDegree);
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(20.0 * kMilliG);
  return dataset;
}

/// Errors of roll, pitch and heading at the start, and their stated sigmas
/// [rad].
struct StartError {
  Eigen::Vector3d error;
  Eigen::Vector3d sigma;
};

StartError ErrorOfStart(std::uint64_t seed, bool print) {
  const Dataset dataset = Recording(seed);
  const Start start =
      FindStart(dataset, dataset.imu.t_begin(), dataset.imu.t_end());
  const StartReport& report = start.report;
  const Eigen::Vector3d truth =
      EulerFromQuaternion(*testing::TruthAt(dataset, report.t).q_nb);
  const Eigen::Vector3d euler = report.state.euler();
  Eigen::Vector3d error;
  for (int i = 0; i < 3; ++i) error(i) = WrapAngle(euler(i) - truth(i));
  const Eigen::Vector3d ratio =
      error.cwiseQuotient(report.attitude_sigma).cwiseAbs();
  if (print) {
    const Eigen::Vector3d e = error / kDegree;
    const Eigen::Vector3d s = report.attitude_sigma / kDegree;
    std::printf(
        "%4d kind %d worst %7.2f  error %7.2f %7.2f %7.2f  sigma %6.2f "
        "%6.2f %6.2f  %s: %s\n",
        static_cast<int>(seed), static_cast<int>(seed % kKinds),
        ratio.maxCoeff(), e.x(), e.y(), e.z(), s.x(), s.y(), s.z(),
        report.alignment.c_str(), report.why.c_str());
  }
  return {error, report.attitude_sigma};
}

int BeyondFourSigmas(std::uint64_t first, int count, bool print) {
  int beyond = 0;
  for (std::uint64_t seed = first;
       seed < first + static_cast<std::uint64_t>(count); ++seed) {
    const StartError e = ErrorOfStart(seed, print);
    if (e.error.cwiseQuotient(e.sigma).cwiseAbs().maxCoeff() > 4.0) ++beyond;
  }
  return beyond;
}

TEST(WarmUp, RollAndPitchAreNoWorseThanLevelling) {
  // Four sigmas of an accelerometer bias of 20 mg.
  constexpr double kLevelling = 4.0 * 0.02;
  for (std::uint64_t seed = 7001; seed < 7001 + testing::SeedCount(kKinds);
       ++seed) {
    const Eigen::Vector3d error = ErrorOfStart(seed, false).error;
    EXPECT_LT(error.head<2>().cwiseAbs().maxCoeff(), kLevelling) << seed;
  }
}

TEST(WarmUp, IsToldBesideTheStatedWalk) {
  for (const std::uint64_t seed : {7004u, 7005u}) {
    const Dataset dataset = Recording(seed);
    const StartReport report =
        FindStart(dataset, dataset.imu.t_begin(), dataset.imu.t_end()).report;
    EXPECT_TRUE(FindGyroDrift(report, dataset.imu.noise)) << seed;
  }
}

TEST(WarmUp, StartsLieWithinFourStatedSigmas) {
  constexpr std::uint64_t kFirst = 60001;
  const int count = testing::SeedCount(kKinds, 300);
  EXPECT_LE(BeyondFourSigmas(kFirst, count, count > kKinds), count / 150);
}

}  // namespace
}  // namespace hindsight
