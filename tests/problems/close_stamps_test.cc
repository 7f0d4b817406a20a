#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

class CloseStampsBy : public ::testing::TestWithParam<double> {};

/// Two sensors with clocks of their own: nodes that are next to nothing apart,
/// between which a good IMU leaves micrometres.
TEST_P(CloseStampsBy, AreNoHarmToTheBatch) {
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

INSTANTIATE_TEST_SUITE_P(Seconds, CloseStampsBy,
                         ::testing::Values(0.0, 2e-6, 3e-5, 1e-4, 1e-3));

/// The DVL's clock ends some recordings milliseconds after its last reading, and
/// positions are known to 10 m: of their variance, what links the last two nodes
/// is 1e-15. Nothing is lost.
TEST(CloseStamps, LeaveTheCovariancesOfADeadReckonedDive) {
  int count = 0;
  for (std::uint64_t seed = 4001; count < 2 && seed < 4100; ++seed) {
    const Dataset dataset = Simulate(FindScenario("straight_dive", {}), seed);
    Reconstruction reconstruction(dataset, {});
    const Solution iterated = reconstruction.Run("iterated");
    const std::size_t last = iterated.states.size() - 1;
    if (iterated.states[last].t - iterated.states[last - 1].t > 0.05) continue;
    ++count;
    const Solution batch = reconstruction.Run("batch");
    ASSERT_TRUE(batch.converged);
    ASSERT_EQ(batch.states.size(), iterated.states.size());
    const auto scaled = [](const Solution& solution, std::size_t k,
                           const Solution& by) -> Eigen::MatrixXd {
      const Eigen::VectorXd sigma =
          by.covariances.Get(k).diagonal().cwiseSqrt();
      return sigma.cwiseInverse().asDiagonal() *
             Eigen::MatrixXd(solution.covariances.Get(k)) *
             sigma.cwiseInverse().asDiagonal();
    };
    for (std::size_t k = 0; k <= last; ++k) {
      EXPECT_LT((scaled(batch, k, iterated) - scaled(iterated, k, iterated))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-3)
          << "seed " << seed << ", node " << k;
    }
    EXPECT_GT(std::sqrt(batch.covariances.Get(last)(0, 0)), 5.0);
  }
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace hindsight
