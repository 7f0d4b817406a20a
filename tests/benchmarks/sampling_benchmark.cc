#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// 30 min at 200 Hz with 1 Hz GNSS, sampled at `state.range(0)` Hz.
void Sampling(benchmark::State& state, const std::string& method) {
  static const Dataset dataset = Simulate(FindScenario("car_drive"), 1);
  static Reconstruction reconstruction(dataset, {});
  const Solution solution = reconstruction.Run(method);
  const auto rate = static_cast<double>(state.range(0));
  std::vector<double> times;
  for (double k = 1.0; k / rate < solution.states.back().t; ++k) {
    if (k / rate > solution.states.front().t) times.push_back(k / rate);
  }
  constexpr std::ptrdiff_t kPiece = 10000;
  for (auto _ : state) {
    for (auto begin = times.begin(); begin != times.end();) {
      const auto end = begin + std::min(kPiece, times.end() - begin);
      const Solution piece = reconstruction.Sample(solution, {begin, end});
      benchmark::DoNotOptimize(piece.states.data());
      begin = end;
    }
  }
}

void SampleForward(benchmark::State& state) { Sampling(state, "ekf"); }
BENCHMARK(SampleForward)->Arg(10)->Arg(200)->Unit(benchmark::kMillisecond);

void SampleSmoothed(benchmark::State& state) { Sampling(state, "rts"); }
BENCHMARK(SampleSmoothed)->Arg(10)->Arg(200)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
