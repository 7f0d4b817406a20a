#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

class CloseStamps : public ::testing::TestWithParam<double> {};

/// Two sensors with clocks of their own: nodes that are next to nothing apart,
/// between which a good IMU leaves micrometres.
TEST_P(CloseStamps, AreNoHarmToTheBatch) {
  Dataset dataset = Simulate(FindScenario("test_dive", {}), 300);
  for (AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->is_position) continue;
    MeasurementSeries later;
    for (Measurement z : stream.measurements) {
      z.t += GetParam();
      later.push_back(z);
    }
    stream.measurements = std::move(later);
  }
  Reconstruction reconstruction(dataset, {});
  const Solution iterated = reconstruction.Run("iterated");
  const Solution batch = reconstruction.Run("batch");
  ASSERT_TRUE(batch.converged);
  ASSERT_EQ(batch.states.size(), iterated.states.size());
  EXPECT_EQ(batch.grade, Grade::kUsable) << batch.verdict;
  double apart = 0.0;
  for (std::size_t k = 0; k < batch.states.size(); ++k) {
    apart =
        std::max(apart, (batch.states[k].p_e - iterated.states[k].p_e).norm());
  }
  // Of a position that is known to 0.3 m.
  EXPECT_LT(apart, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Seconds, CloseStamps,
                         ::testing::Values(0.0, 2e-6, 3e-5, 1e-4, 1e-3));

}  // namespace
}  // namespace hindsight
