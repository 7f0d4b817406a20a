#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "io/read/reader.h"

namespace hindsight {
namespace {

/// 30 min at 200 Hz in the digits the writers use.
std::string WriteImuFile() {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / "hindsight_reader_benchmark.csv";
  std::ofstream out(path, std::ios::binary);
  out << "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
         "accel_y[m/s^2],accel_z[m/s^2]\n";
  for (int i = 0; i < 360000; ++i) {
    const double s = std::sin(0.37 * i);
    out << fmt::format(
        "{:.4f},{:.15g},{:.15g},{:.15g},{:.15g},{:.15g},{:.15g}\n", 0.005 * i,
        0.01 * s, 0.02 * s, -0.013 * s, 0.3 * s, 0.1 * s, -9.8 + 0.2 * s);
  }
  return path.string();
}

void BM_ReadImuCsv(benchmark::State& state) {
  StreamSource source;
  source.name = "imu";
  source.path = WriteImuFile();
  const auto bytes = std::filesystem::file_size(source.path);
  for (auto _ : state) {
    StreamClock clock;
    std::vector<PolicyCount> policies;
    benchmark::DoNotOptimize(ReadImu(source, {}, &clock, &policies));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) *
                          state.iterations());
  std::filesystem::remove(source.path);
}
BENCHMARK(BM_ReadImuCsv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
