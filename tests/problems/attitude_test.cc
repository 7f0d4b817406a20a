#include "problems/attitude.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "evaluation/chi_square.h"
#include "geometry/so3.h"
#include "problems/vibration_comparison.h"
#include "simulation/vibration_attitude.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

VibrationAttitudeOptions Calm() {
  VibrationAttitudeOptions options;
  options.acceleration = 0.0;
  options.vibration_sigma = 0.0;
  return options;
}

/// e' P^-1 e of attitude and gyro bias at sample k.
double Nees(const Dataset& dataset, const Solution& solution, std::size_t k) {
  const State& x = solution.states[k];
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(x.C_en()).conjugate() * x.q_eb;
  Eigen::Matrix<double, 6, 1> e;
  e << Log(*dataset.truth[k].q_nb * q_nb.conjugate()),
      *dataset.truth[k].b_g - x.b_g;
  const Eigen::Matrix<double, 6, 6> P = solution.covariances.Get(k);
  return e.dot(P.llt().solve(e));
}

TEST(AttitudeEstimation, FilterAndSmootherAreConsistent) {
  constexpr int kRuns = testing::SeedCount(60);
  double filter = 0.0;
  double smoother = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Dataset dataset = SimulateVibrationAttitude(Calm(), seed);
    AttitudeEstimation estimation(dataset, {});
    filter += Nees(dataset, estimation.Run("ahrs"), 300) / kRuns;
    smoother += Nees(dataset, estimation.Run("ahrs_smoother"), 300) / kRuns;
  }
  const Interval bounds = AneesBounds(kRuns, 6, 0.999);
  EXPECT_TRUE(bounds.Contains(filter)) << filter;
  EXPECT_TRUE(bounds.Contains(smoother)) << smoother;
}

TEST(AttitudeEstimation, SmncWithstandsVibration) {
  constexpr std::size_t kVibration = 3;
  constexpr std::size_t kAfterTenSeconds = 5;
  const std::vector<VibrationResult> results = CompareUnderVibration(
      [](std::uint64_t seed) { return SimulateVibrationAttitude({}, seed); },
      20, 1, nullptr, nullptr);
  const auto find = [&](const std::string& name) {
    for (const VibrationResult& result : results) {
      if (result.name == name) return result.intervals;
    }
    throw std::logic_error(name);
  };
  const auto smnc = find("smnc");
  constexpr double kExpected = 0.22 * kDegree;
  EXPECT_NEAR(smnc[kVibration].rms_total, kExpected, 0.1 * kExpected);
  EXPECT_GT(smnc[kVibration].inside, 0.99);
  EXPECT_LT(smnc[kAfterTenSeconds].rms_total, 0.33 * kDegree);
  const double gate = find("gate 0.88")[kVibration].rms_total;
  EXPECT_LT(smnc[kVibration].rms_total, 0.7 * gate);
  EXPECT_NEAR(find("held gate 0.88")[kVibration].rms_total,
              smnc[kVibration].rms_total, 0.1 * kExpected);
}

TEST(AttitudeEstimation, SolutionsAreGivenAtTheStampsOfTheFile) {
  Dataset dataset = SimulateVibrationAttitude(Calm(), 3);
  const std::vector<ImuSample> samples = dataset.imu.samples;
  dataset.imu.stamp_offset = -0.02;
  for (ImuSample& sample : dataset.imu.samples) sample.t -= 0.02;
  AttitudeEstimation estimation(dataset, {});
  const Solution solution = estimation.Run("ahrs");
  ASSERT_EQ(solution.states.size(), samples.size());
  ASSERT_EQ(solution.covariances.size(), samples.size());
  ASSERT_EQ(solution.accel_sigma.size(), samples.size());
  for (std::size_t k = 0; k < samples.size(); k += 50) {
    EXPECT_NEAR(solution.states[k].t, samples[k].t, 1e-12);
  }
}

/// A body swung about in a room, three times its own weight at the peaks.
Dataset Swing() {
  Dataset dataset;
  constexpr double kStep = 0.01;
  const Eigen::Vector3d kAmplitude(0.3, 0.2, 0.15);
  const double kRate = 5.0;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  AidingStream magnetometer;
  magnetometer.sensor.type = SensorType::kMagnetometer;
  const auto w_at = [](double t) {
    return Eigen::Vector3d(0.8 * std::sin(0.7 * t), 0.6 * std::cos(0.9 * t),
                           0.7 * std::sin(1.1 * t));
  };
  for (int k = 0; k <= 4000; ++k) {
    const double t = k * kStep;
    if (k > 0) {
      q_nb = (q_nb * Exp(kStep * w_at(t - 0.5 * kStep))).normalized();
    }
    const Eigen::Vector3d a_n =
        -kRate * kRate * kAmplitude * std::sin(kRate * t);
    dataset.imu.samples.push_back(
        {t, w_at(t),
         q_nb.conjugate() *
             (a_n - Eigen::Vector3d(0.0, 0.0, kStandardGravity))});
    magnetometer.measurements.push_back(
        {t, 0, false,
         MagneticField{q_nb.conjugate() * Eigen::Vector3d(20.0, 0.0, 40.0), 3.5,
                       MagneticField::Form::kVector}});
    TruthPoint truth;
    truth.t = t;
    truth.q_nb = q_nb;
    dataset.truth.push_back(truth);
  }
  dataset.imu.noise.gyro_noise_density = 1e-4;
  dataset.imu.noise.accel_noise_density = 1e-2;
  dataset.streams.push_back(magnetometer);
  return dataset;
}

Eigen::Quaterniond NedAttitude(const State& x) {
  return Eigen::Quaterniond(x.C_en()).conjugate() * x.q_eb;
}

/// Largest error of attitude from 5 s to 35 s [rad].
double LargestError(const Dataset& dataset, const Solution& solution) {
  double largest = 0.0;
  for (std::size_t k = 500; k < 3500; k += 100) {
    largest = std::max(largest, NedAttitude(solution.states[k])
                                    .angularDistance(*dataset.truth[k].q_nb));
  }
  return largest;
}

TEST(AttitudeEstimation, BatchSeesTheHorizonThroughTheSwing) {
  const Dataset dataset = Swing();
  AttitudeEstimation estimation(dataset, {});
  const Solution batch = estimation.Run("ahrs_batch");
  const Solution tilt = estimation.Run("ahrs_tilt_batch");
  ASSERT_EQ(batch.states.size(), dataset.imu.samples.size());
  ASSERT_EQ(tilt.states.size(), dataset.imu.samples.size());
  EXPECT_TRUE(batch.converged);
  EXPECT_TRUE(tilt.converged);
  EXPECT_LT(LargestError(dataset, batch), 0.5 * kDegree);
  // To a tilt sensor the swing is noise.
  EXPECT_LT(LargestError(dataset, batch), LargestError(dataset, tilt));
}

/// 30 uT that travel along, and 30 uT that pass by for a quarter of the time:
/// had these their full say they would turn the heading by some 20 deg; the
/// swing adds its own.
TEST(AttitudeEstimation, SmootherAndBatchesSeeThroughMagnets) {
  const Eigen::Vector3d magnet(15.0, -20.0, 16.0);
  for (const bool attached : {true, false}) {
    Dataset dataset = Swing();
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      Eigen::Vector3d& field_b = std::get<MagneticField>(z.model).field_b;
      const auto k = static_cast<std::size_t>(std::lround(z.t / 0.01));
      if (attached) {
        field_b += magnet;
      } else if (z.t > 12.0 && z.t < 22.0) {
        field_b += dataset.truth[k].q_nb->conjugate() * magnet;
      }
    }
    AttitudeEstimation estimation(dataset, {});
    for (const std::string method :
         {"ahrs_smoother", "ahrs_batch", "ahrs_tilt_batch"}) {
      const Solution solution = estimation.Run(method);
      EXPECT_LT(LargestError(dataset, solution), 4.5 * kDegree)
          << method << (attached ? " attached" : " passing");
      const bool flagged = std::count(solution.magnetic.begin(),
                                      solution.magnetic.end(), -1) > 0;
      EXPECT_EQ(flagged, !attached);
    }
  }
}

}  // namespace
}  // namespace hindsight
