#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cstring>
#include <vector>

namespace hindsight {
namespace {

/// C += A B of 15 x 15, all in the first cache: what the processor does of the
/// products that a node consists of, with sizes that the compiler knows.
void MachineProducts(benchmark::State& state) {
  using Square = Eigen::Matrix<double, 15, 15>;
  const Square A = 1e-3 * Square::Random();
  const Square B = 1e-3 * Square::Random();
  Square C = Square::Zero();
  for (auto _ : state) {
    C.noalias() += A * B;
    benchmark::DoNotOptimize(C.data());
    benchmark::ClobberMemory();
  }
  constexpr double kOperations = 2.0 * 15 * 15 * 15;
  state.counters["flop_per_s"] =
      benchmark::Counter(kOperations * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}
BENCHMARK(MachineProducts);

/// Copies 64 MB, beyond all caches: bytes read and written a second.
void MachineMemory(benchmark::State& state) {
  constexpr std::size_t kBytes = std::size_t{1} << 26;
  const std::vector<char> from(kBytes, 1);
  std::vector<char> to(kBytes);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), kBytes);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(2 * kBytes) *
                          state.iterations());
}
BENCHMARK(MachineMemory)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
