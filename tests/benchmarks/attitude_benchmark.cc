#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cmath>

#include "alignment/attitude_start.h"
#include "attitude/attitude_run.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// A sensor waved about for 190 s at 286 Hz, rates up to some 300 deg/s.
const Dataset& Waved() {
  static const Dataset dataset = [] {
    Dataset waved;
    constexpr double kStep = 0.0035;
    AidingStream magnetometer;
    magnetometer.sensor.kind = &MagnetometerKind();
    Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
    for (int k = 0; k < 54286; ++k) {
      const double t = k * kStep;
      const Eigen::Vector3d w(3.0 * std::sin(2.1 * t), 4.0 * std::cos(1.7 * t),
                              3.5 * std::sin(1.3 * t));
      q_nb = (q_nb * Exp(kStep * w)).normalized();
      const Eigen::Vector3d a_n(3.0 * std::sin(5.0 * t),
                                2.0 * std::cos(4.0 * t), std::sin(6.0 * t));
      waved.imu.samples.push_back(
          {t, w,
           q_nb.conjugate() * (a_n - Eigen::Vector3d(0.0, 0.0, 9.80665))});
      magnetometer.measurements.push_back(
          {t, 0, false,
           MagneticField{q_nb.conjugate() * Eigen::Vector3d(20.0, 0.0, 40.0),
                         3.5, MagneticField::Form::kVector}});
    }
    waved.imu.noise.gyro_noise_density = 3.5e-4;
    waved.imu.noise.accel_noise_density = 0.05;
    waved.imu.noise.gyro_bias_walk = 8.7e-5;
    waved.imu.noise.gyro_noise_per_rate = 2e-3;
    waved.streams.push_back(std::move(magnetometer));
    return waved;
  }();
  return dataset;
}

void BM_AttitudeFilter(benchmark::State& state) {
  const std::vector<MagneticSample> magnetic = MagneticSamples(Waved());
  const AttitudeFilterOptions options = FilterOptionsOf(Waved());
  const AttitudeState start = StartOfAttitude(Waved(), Waved().imu, magnetic);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        RunAttitudeFilter(Waved().imu, {magnetic}, options, start));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(
                                                   Waved().imu.samples.size()));
}
BENCHMARK(BM_AttitudeFilter)->Unit(benchmark::kMillisecond);

/// Keeps freed memory with the process: from the second round on a round pays
/// for what it computes, and not for the kernel's zeroing of 420 bytes of state
/// a sample, which depends on the machine and what it did before.
void KeepMemory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

/// With its surveys of the field, as Solution::seconds counts it: without what
/// grades the result.
void BM_AttitudeSmoother(benchmark::State& state) {
  KeepMemory();
  AttitudeEstimation(Waved(), AttitudeAlone()).Smoother();
  for (auto _ : state) {
    AttitudeEstimation estimation(Waved(), AttitudeAlone());
    benchmark::DoNotOptimize(estimation.Smoother());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(
                                                   Waved().imu.samples.size()));
}
BENCHMARK(BM_AttitudeSmoother)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
