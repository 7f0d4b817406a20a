#include <benchmark/benchmark.h>

#include "base/random.h"
#include "linear/arrow_system.h"

namespace hindsight {
namespace {

// Nodes of well conditioned random blocks: the time does not depend on values.
void Fill(ArrowSystem* system) {
  const int n = system->node_dim();
  const int m = system->border_dim();
  Random random(1);
  system->SetZero();
  for (int k = 0; k < system->nodes(); ++k) {
    system->node(k).diagonal().setConstant(10.0 * n);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n && k + 1 < system->nodes(); ++i) {
        system->coupling(k)(i, j) = random.Normal();
      }
      for (int i = 0; i < m; ++i) {
        system->border_coupling(k)(i, j) = random.Normal();
      }
    }
    system->rhs(k).setOnes();
  }
  system->border().diagonal().setConstant(10.0 * n * system->nodes());
}

ArrowSystem MakeSystem(const benchmark::State& state) {
  ArrowSystem system(static_cast<int>(state.range(0)),
                     static_cast<int>(state.range(1)),
                     static_cast<int>(state.range(2)));
  Fill(&system);
  return system;
}

void ArrowFactorAndSolve(benchmark::State& state) {
  const ArrowSystem filled = MakeSystem(state);
  ArrowSystem system = filled;
  for (auto _ : state) {
    state.PauseTiming();
    system = filled;
    state.ResumeTiming();
    system.Factor();
    system.Solve();
    benchmark::DoNotOptimize(system.rhs(0).data());
  }
}

void ArrowMarginals(benchmark::State& state) {
  ArrowSystem system = MakeSystem(state);
  system.Factor();
  double sum = 0.0;
  for (auto _ : state) {
    system.VisitMarginals([&sum](const ArrowSystem::NodeMarginal& marginal) {
      sum += marginal.covariance(0, 0);
    });
  }
  benchmark::DoNotOptimize(sum);
}

// Arguments: nodes, unknowns a node, border unknowns.
void Sizes(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)
      ->Args({1800, 15, 0})
      ->Args({3600, 15, 0})
      ->Args({1800, 15, 8})
      ->Args({1800, 24, 0})
      ->Args({1800, 36, 33});
}
BENCHMARK(ArrowFactorAndSolve)->Apply(Sizes);
BENCHMARK(ArrowMarginals)->Apply(Sizes);

}  // namespace
}  // namespace hindsight
