#include <benchmark/benchmark.h>

#include "base/random.h"
#include "linear/arrow_least_squares.h"

namespace hindsight {
namespace {

// Well conditioned random rows, three of a node and as many as unknowns of a
// link: the time does not depend on values.
ArrowLeastSquares Fill(const benchmark::State& state) {
  const int nodes = static_cast<int>(state.range(0));
  const int n = static_cast<int>(state.range(1));
  ArrowLeastSquares arrow(nodes, n, static_cast<int>(state.range(2)));
  Random random(1);
  const auto draw = [&random](auto block) {
    for (int i = 0; i < block.rows(); ++i) {
      for (int j = 0; j < block.cols(); ++j) block(i, j) = random.Normal();
    }
  };
  for (int k = 0; k < nodes; ++k) {
    ArrowLeastSquares::Rows rows = arrow.AddToNode(k, k == 0 ? n : 3);
    draw(rows.node());
    draw(rows.border());
    if (k + 1 == nodes) continue;
    ArrowLeastSquares::Rows link = arrow.AddToLink(k, n);
    draw(link.node());
    draw(link.next());
    draw(link.border());
  }
  return arrow;
}

void ArrowSolve(benchmark::State& state) {
  for (auto _ : state) {
    ArrowLeastSquares arrow = Fill(state);
    arrow.Solve();
    benchmark::DoNotOptimize(arrow.x(0).data());
  }
}

void ArrowMarginals(benchmark::State& state) {
  ArrowLeastSquares arrow = Fill(state);
  arrow.Solve();
  double sum = 0.0;
  for (auto _ : state) {
    arrow.VisitMarginals(
        [&sum](const ArrowLeastSquares::NodeMarginal& marginal) {
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
BENCHMARK(ArrowSolve)->Apply(Sizes);
BENCHMARK(ArrowMarginals)->Apply(Sizes);

}  // namespace
}  // namespace hindsight
