#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "base/chi_square.h"
#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

const ConstantEstimate& Constant(const Solution& solution,
                                 const std::string& name) {
  return *std::find_if(solution.constants.begin(), solution.constants.end(),
                       [&](const auto& c) { return c.name == name; });
}

/// On a steady way no acceleration tells when a precise DVL measures, and the
/// noise of a phone's IMU must not pass for one: 50 ms stay 50 ms.
TEST(TimeOffset, IsNotToldByTheNoiseOfTheImu) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("steady.yaml", R"(name: steady
start: {position: [42 deg, 127 deg, -10 m], heading: 349 deg, speed: 1.5 m/s}
segments:
  - {type: straight, duration: 60 s}
imu:
  kind: rates
  rate: 200 Hz
  noise: {gyro: 0.6 deg/sqrt(h), accel: 300 ug/sqrt(Hz)}
  gyro_bias_sigma: 100 deg/h
  accel_bias_sigma: 5 mg
aiding:
  dvl: {type: dvl, rate: 5 Hz, sigma: 2 mm/s, estimate: {time_offset: 50 ms}}
truth_rate: 1 Hz
start_errors: {position: 0.1 m, velocity: 0.05 m/s, attitude: [0.05 deg, 0.5 deg, 2 deg]}
)");
  constexpr int kRuns = 8;
  double sum = 0.0;
  for (std::uint64_t seed = 6401; seed < 6401 + kRuns; ++seed) {
    const Dataset dataset = Simulate(FindScenario(path, {}), seed);
    Reconstruction reconstruction(dataset, {});
    const Solution batch = reconstruction.Run("batch");
    const ConstantEstimate& offset = Constant(batch, "dvl_time_offset");
    EXPECT_NE(offset.verdict, ConstantEstimate::Verdict::kObserved) << seed;
    const double error =
        offset.value - dataset.true_constants.at("dvl_time_offset");
    sum += error * error / (offset.sigma * offset.sigma);
  }
  EXPECT_TRUE(AneesBounds(kRuns, 1, 0.999).Contains(sum / kRuns)) << sum;
}

}  // namespace
}  // namespace hindsight
