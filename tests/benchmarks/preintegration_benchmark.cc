#include <benchmark/benchmark.h>

#include <ctime>

#include "support/test_motion.h"

namespace hindsight {
namespace {

double ThreadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec);
}

/// The yardstick: the covariance step of a 16-state filter, nothing around it.
double SecondsOfCovarianceSteps(int count) {
  using Matrix16 = Eigen::Matrix<double, 16, 16>;
  const Matrix16 F = Matrix16::Identity() + 1e-3 * Matrix16::Random();
  const Matrix16 Q = 1e-6 * Matrix16::Identity();
  Matrix16 P = Matrix16::Identity();
  Matrix16 FP;
  const double t0 = ThreadSeconds();
  for (int i = 0; i < count; ++i) {
    FP.noalias() = F * P;
    P = Q;
    P.noalias() += FP * F.transpose();
    benchmark::DoNotOptimize(P.data());
    // Bounded, whatever the eigenvalues of F.
    if (i % 1000 == 0) P.setIdentity();
  }
  return ThreadSeconds() - t0;
}

/// Summaries of 1 s at 200 Hz of a tactical IMU. `to_covariance_step` is the
/// time of a sample in covariance steps, measured side by side.
void Preintegration(benchmark::State& state) {
  constexpr int kSeconds = 60;
  constexpr double kRate = 200.0;
  ImuNoise noise;
  noise.gyro_noise_density = 3e-5;
  noise.accel_noise_density = 1e-3;
  if (state.range(0) != 0) {
    noise.gyro_bias_walk = 1e-7;
    noise.accel_bias_walk = 1e-5;
  }
  ImuStream stream = testing::LivelyImu(kSeconds, kRate, noise);
  stream.kind = ImuStream::Kind::kIncrements;
  for (ImuSample& s : stream.samples) {
    s.gyro /= kRate;
    s.accel /= kRate;
  }
  double seconds = 0.0;
  double yardstick = 0.0;
  double samples = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    yardstick += SecondsOfCovarianceSteps(kSeconds * 200);
    state.ResumeTiming();
    const double t0 = ThreadSeconds();
    ImuIntegrator integrator(stream);
    for (int k = 0; k < kSeconds; ++k) {
      const ImuSummary summary =
          integrator.Summarize(k, k + 1.0, ImuCalibration());
      benchmark::DoNotOptimize(summary.dp.data());
    }
    seconds += ThreadSeconds() - t0;
    samples += kSeconds * kRate;
  }
  state.counters["ns_per_sample"] = 1e9 * seconds / samples;
  state.counters["ns_per_covariance_step"] = 1e9 * yardstick / samples;
  state.counters["to_covariance_step"] = seconds / yardstick;
}
BENCHMARK(Preintegration)
    ->ArgName("bias_walk")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
