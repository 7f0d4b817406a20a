#include "problems/noise_estimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "base/random.h"
#include "io/config/scenario_config.h"
#include "measurements/noise_kind.h"

namespace hindsight {
namespace {

Dataset NoisyDrive() {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 300.0;
  scenario.withholdings.clear();
  return Simulate(scenario, 1);
}

/// ln of every factor over its standard deviation, by name.
std::map<std::string, double> Normalised(const NoiseEstimate& estimate,
                                         const std::string& scaled,
                                         double factor) {
  std::map<std::string, double> normalised;
  for (const NoiseFactor& noise : estimate.factors) {
    const double truth = noise.name == scaled ? 1.0 / factor : 1.0;
    normalised[noise.name] = std::log(noise.factor / truth) / noise.log_sigma;
  }
  return normalised;
}

TEST(NoiseEstimation, FindsWhatTheStatedNoiseIsOffBy) {
  constexpr double kFourSigma = 4.0;
  for (const double factor : {1.0, 5.0, 0.1}) {
    Dataset dataset = NoisyDrive();
    ASSERT_FALSE(dataset.streams.empty());
    AidingStream& gnss = dataset.streams.front();
    for (Measurement& z : gnss.measurements.Edited()) ScaleSigma(factor, &z);
    const NoiseEstimate estimate = EstimateNoise(dataset);
    EXPECT_TRUE(estimate.converged);
    EXPECT_GE(estimate.log_likelihood_after, estimate.log_likelihood_before);
    for (const auto& [name, error] :
         Normalised(estimate, gnss.sensor.name, factor)) {
      EXPECT_LT(std::abs(error), kFourSigma) << name << " " << factor;
    }
  }
}

TEST(NoiseEstimation, FindsAnErrorThatLasts) {
  constexpr double kSigma = 0.5;
  constexpr double kTau = 8.0;
  constexpr double kFourSigma = 4.0;
  Dataset dataset = NoisyDrive();
  AidingStream& gnss = dataset.streams.front();
  Random random(7);
  const double phi = std::exp(-1.0 / kTau);  // fixes come at 1 Hz
  Eigen::Vector3d error = kSigma * random.NormalVector3();
  for (Measurement& z : gnss.measurements.Edited()) {
    std::get<PositionFix>(z.model).p_e += error;
    error = phi * error +
            kSigma * std::sqrt(1 - phi * phi) * random.NormalVector3();
  }
  NoiseModel& noise = gnss.sensor.noise;
  noise.kind = &GaussMarkovNoise();
  noise.sigma = 3.0;
  noise.tau = 40.0;
  noise.white_sigma = 0.2;
  const NoiseEstimate estimate = EstimateNoise(dataset);
  EXPECT_TRUE(estimate.converged);
  const std::map<std::string, double> truth = {
      {"gnss.gauss_markov", kSigma / noise.sigma},
      {"gnss.gauss_markov_tau", kTau / noise.tau}};
  int found = 0;
  for (const NoiseFactor& factor : estimate.factors) {
    const auto at = truth.find(factor.name);
    if (at == truth.end()) continue;
    ++found;
    EXPECT_LT(std::abs(std::log(factor.factor / at->second)) / factor.log_sigma,
              kFourSigma)
        << factor.name << " " << factor.factor;
  }
  EXPECT_EQ(found, 2);
}

TEST(NoiseEstimation, TheStartDoesNotDecide) {
  Dataset dataset = NoisyDrive();
  const NoiseEstimate from_right = EstimateNoise(dataset);
  dataset.imu.noise.accel_noise_density *= 10.0;
  dataset.imu.noise.gyro_noise_density *= 0.2;
  const NoiseEstimate from_wrong = EstimateNoise(dataset);
  EXPECT_NEAR(from_right.log_likelihood_after, from_wrong.log_likelihood_after,
              0.5);
}

}  // namespace
}  // namespace hindsight
