#include "dataset/fix_noise.h"

#include <gtest/gtest.h>

#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "simulation/scenario.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

Dataset DriveWithFixes(double sigma, double rate_hz, std::uint64_t seed) {
  Scenario scenario = FindScenario("short_drive");
  scenario.segments = WanderingDrive(180.0, seed);
  AidingModel model(PositionKind());
  model.sensor.name = "gnss";
  model.sigma = Eigen::Vector3d::Constant(sigma);
  model.rate_hz = rate_hz;
  scenario.aiding = {model};
  return Simulate(scenario, seed);
}

/// Of three axes and 180 s the estimate scatters by some per cent; what the motion
/// adds is allowed to be a third.
TEST(FixNoise, IsWhatWasDrawnWhateverTheMotion) {
  for (const auto& [sigma, rate] :
       {std::pair(2.0, 1.0), {0.5, 1.0}, {0.5, 5.0}, {0.05, 5.0}}) {
    const Dataset dataset = DriveWithFixes(sigma, rate, 21);
    const auto found =
        NoiseOfFixes(dataset.imu, dataset.initial, dataset.streams[0]);
    ASSERT_TRUE(found);
    EXPECT_GT(*found, 0.85 * sigma) << sigma << " m at " << rate << " Hz";
    EXPECT_LT(*found, 1.35 * sigma) << sigma << " m at " << rate << " Hz";
  }
}

TEST(FixNoise, OfAFewFixesIsUnknown) {
  Dataset dataset = DriveWithFixes(0.5, 1.0, 22);
  int k = 0;
  for (Measurement& z : dataset.streams[0].measurements.Edited()) {
    z.withheld = ++k > 15;
  }
  EXPECT_FALSE(NoiseOfFixes(dataset.imu, dataset.initial, dataset.streams[0]));
}

}  // namespace
}  // namespace hindsight
