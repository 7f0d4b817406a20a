#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>

#include "benchmarks/baselines.h"
#include "benchmarks/smoothed_drive.h"
#include "problems/batch.h"

namespace hindsight {
namespace {

SmoothedDrive& DriveOf(int rate) {
  static std::map<int, Dataset> datasets;
  static std::map<int, SmoothedDrive> drives;
  if (!drives.contains(rate)) {
    datasets.emplace(rate, WalkingDrive(std::to_string(rate) + " Hz"));
    drives.emplace(rate, SmoothedDrive(datasets.at(rate)));
  }
  return drives.at(rate);
}

double Milliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now() - begin)
      .count();
}

/// Ours in full (forward filter, RTS, batch, the covariances of all three)
/// against baselines that are given the filter's trajectory and take no time for
/// it; then the batch alone against them, all from the smoother's trajectory. All
/// with marginal covariances of all nodes but Ceres (CeresWithCovariances).
/// The counters *_to_* are ratios of times measured in turn in one process.
void Ratios(benchmark::State& state) {
  SmoothedDrive& drive = DriveOf(static_cast<int>(state.range(0)));
  double full = 0.0;
  double batch = 0.0;
  double ceres_filtered = 0.0;
  double ceres_smoothed = 0.0;
  double bare_filtered = 0.0;
  double bare_smoothed = 0.0;
  for (auto _ : state) {
    full += Milliseconds([&] {
      const LinearTape tape = RunExtendedKalmanFilter(&drive.problem);
      const SmoothedTrajectory smoothed = SmoothRts(tape);
      benchmark::DoNotOptimize(SolveBatch(smoothed.states, {}, &drive.problem));
    });
    batch += Milliseconds([&] {
      benchmark::DoNotOptimize(SolveBatch(drive.states, {}, &drive.problem));
    });
    ceres_filtered += Milliseconds([&] {
      benchmark::DoNotOptimize(
          SolveByCeres(drive.filtered, false, &drive.problem));
    });
    ceres_smoothed += Milliseconds([&] {
      benchmark::DoNotOptimize(
          SolveByCeres(drive.states, false, &drive.problem));
    });
    bare_filtered += Milliseconds([&] {
      benchmark::DoNotOptimize(
          SolveBlockTridiagonal(drive.filtered, &drive.problem));
    });
    bare_smoothed += Milliseconds([&] {
      benchmark::DoNotOptimize(
          SolveBlockTridiagonal(drive.states, &drive.problem));
    });
  }
  const auto count = static_cast<double>(state.iterations());
  state.counters["nodes"] = static_cast<double>(drive.states.size());
  state.counters["full_ms"] = full / count;
  state.counters["batch_ms"] = batch / count;
  state.counters["full_to_ceres"] = full / ceres_filtered;
  state.counters["full_to_bare"] = full / bare_filtered;
  state.counters["batch_to_ceres"] = batch / ceres_smoothed;
  state.counters["batch_to_bare"] = batch / bare_smoothed;
}
BENCHMARK(Ratios)
    ->ArgName("fixes_hz")
    ->Arg(1)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond);

/// What Ceres takes for the marginal covariances of all nodes besides.
void CeresWithCovariances(benchmark::State& state) {
  SmoothedDrive& drive = DriveOf(1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        SolveByCeres(drive.filtered, true, &drive.problem));
  }
}
BENCHMARK(CeresWithCovariances)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
