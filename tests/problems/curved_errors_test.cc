#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/mean_nees.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

/// A car by its odometer alone, whose heading at the start is known to 10 deg:
/// what no covariance describes is not usable without a word.
TEST(CurvedErrors, OfADeadReckonedCarAreDoubtful) {
  const TemporaryFolder folder;
  const std::string path =
      folder.Write("odometer_alone.yaml", R"(name: odometer_alone
start: {position: [48 deg, 11.5 deg, 500 m], heading: 40 deg}
wander: {duration: 60 s, seed: 4}
imu:
  kind: increments
  rate: 50 Hz
  noise: {gyro: 0.15 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}
  gyro_bias_sigma: 10 deg/h
  accel_bias_sigma: 2 mg
aiding:
  odometer: {type: odometer, rate: 1 Hz, sigma: 0.05 m/s}
truth_rate: 1 Hz
start_errors: {position: 0.5 m, velocity: 0.1 m/s, attitude: [0.3 deg, 0.3 deg, 10 deg]}
)");
  double worst = 0.0;
  for (std::uint64_t seed = 8801; seed <= 8806; ++seed) {
    const Dataset dataset = Simulate(FindScenario(path, {}), seed);
    Reconstruction reconstruction(dataset, {});
    const Solution batch = reconstruction.Run("batch");
    EXPECT_TRUE(batch.converged);
    const double nees = MeanNees(dataset, batch, BlockKind::kPosition);
    worst = std::max(worst, nees);
    EXPECT_TRUE(nees < 25.0 || batch.grade != Grade::kUsable)
        << seed << ": " << nees << ", " << batch.verdict;
  }
  EXPECT_GT(worst, 25.0);
}

}  // namespace
}  // namespace hindsight
