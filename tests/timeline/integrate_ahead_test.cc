#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "timeline/timeline.h"

namespace hindsight {
namespace {

constexpr std::size_t kNodes = 1400;
constexpr double kSpacing = 0.05;         // [s]
constexpr double kSampleInterval = 0.01;  // [s]

/// A slowly turning IMU.
ImuStream Stream() {
  ImuStream imu;
  for (double t = 0.0; t < kNodes * kSpacing + 1.0; t += kSampleInterval) {
    imu.samples.push_back({t,
                           {0.1 * std::sin(t), 0.02, 0.3 * std::cos(0.2 * t)},
                           {std::sin(0.5 * t), 0.1, -9.8}});
  }
  imu.nominal_dt = kSampleInterval;
  imu.noise.gyro_noise_density = 1e-4;
  imu.noise.accel_noise_density = 1e-3;
  return imu;
}

/// As a filter has it at a node that has learnt the biases.
ImuCalibration At(std::size_t k) {
  ImuCalibration calibration;
  calibration.b_g.setConstant(1e-5 + 1e-10 * static_cast<double>(k));
  calibration.b_a.setConstant(1e-2 + 1e-7 * static_cast<double>(k));
  return calibration;
}

std::vector<ImuSummary> IntegrateAll(const ImuStream& imu, int threads) {
  const int before = ThreadCount();
  SetThreadCount(threads);
  std::vector<Node> nodes(kNodes);
  for (std::size_t k = 0; k < kNodes; ++k) {
    nodes[k].t = kSpacing * static_cast<double>(k);
  }
  Timeline timeline(std::move(nodes), {}, {}, imu, false);
  std::vector<ImuSummary> all;
  for (std::size_t k = 0; k + 1 < kNodes; ++k) {
    all.push_back(timeline.Integrate(k, At(k)));
  }
  SetThreadCount(before);
  return all;
}

TEST(IntegrateAhead, IsTheSameForAnyNumberOfThreads) {
  const ImuStream imu = Stream();
  const std::vector<ImuSummary> one = IntegrateAll(imu, 1);
  const std::vector<ImuSummary> two = IntegrateAll(imu, 2);
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].dv, two[k].dv) << k;
    ASSERT_EQ(one[k].noise, two[k].noise) << k;
    ASSERT_EQ(one[k].calibration.b_a, two[k].calibration.b_a) << k;
  }
}

TEST(IntegrateAhead, GivesWhatIntegratingAtEachNodeGives) {
  const ImuStream imu = Stream();
  ImuIntegrator integrator(imu);
  const std::vector<ImuSummary> all = IntegrateAll(imu, 2);
  std::size_t ahead = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const ImuSummary own = integrator.Summarize(all[k].t_i, all[k].t_j, At(k));
    ASSERT_NEAR(all[k].t_i, kSpacing * static_cast<double>(k), 1e-12);
    const CorrectedMean mean = Correct(all[k], At(k));
    // Sensitivities are trapezoidal over a sample, in which the IMU turns so far.
    constexpr double kTurn = 0.32 * kSampleInterval;
    constexpr double kRounding = 1e-15;
    EXPECT_LE((mean.dv - own.dv).norm(),
              kTurn * kTurn * (mean.dv - all[k].dv).norm() + kRounding)
        << k;
    ahead += all[k].calibration.b_a == At(k).b_a ? 0 : 1;
  }
  // Most of those behind the first 1024; of these none.
  EXPECT_GT(ahead, 200u);
  EXPECT_LT(ahead, kNodes - 1024);
}

}  // namespace
}  // namespace hindsight
