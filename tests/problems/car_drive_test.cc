#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/units.h"
#include "evaluation/trajectory_error.h"
#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

/// Means over seeds of one method on the built-in car drive.
struct Accuracy {
  double largest_in_outages = 0.0;  ///< horizontal [m]
  double tilt_rms = 0.0;            ///< [rad]
  double nees = 0.0;                ///< of position, 3 degrees of freedom

  void Add(const Solution& solution, const Dataset& dataset, int seeds) {
    const std::vector<TrajectoryError> errors =
        ComputeTrajectoryErrors(TableFromSolution(solution), dataset.truth, {});
    double largest = 0.0;
    for (const TrajectoryError& e : errors) {
      for (const Outage& outage : dataset.outages) {
        if (e.t < outage.t_begin || e.t > outage.t_end) continue;
        largest = std::max(largest, e.position->head<2>().norm());
      }
    }
    const TrajectoryStatistics statistics =
        SummarizeErrors(errors, dataset.truth.size());
    largest_in_outages += largest / seeds;
    tilt_rms += statistics.attitude->tilt.rms / seeds;
    nees += *statistics.position_nees / seeds;
  }
};

/// Half an hour, tactical IMU, three outages of 60 s: the figures that a right
/// whole-interval estimator reaches on such a drive.
TEST(CarDrive, WholeIntervalAccuracyAndConsistency) {
  constexpr int kSeeds = testing::SeedCount(50);
  Scenario scenario = FindScenario("car_drive");
  scenario.truth_rate_hz = 1.0;
  const PerfectRecording recording(scenario);
  Accuracy filter, smoother, batch;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Dataset dataset = recording.Realize(static_cast<std::uint64_t>(seed));
    ASSERT_EQ(dataset.outages.size(), 3u);
    Reconstruction reconstruction(dataset, {});
    filter.Add(reconstruction.Run("ekf"), dataset, kSeeds);
    smoother.Add(reconstruction.Run("rts"), dataset, kSeeds);
    batch.Add(reconstruction.Run("batch"), dataset, kSeeds);
  }
  RecordProperty("filter_largest_m", std::to_string(filter.largest_in_outages));
  for (const Accuracy* whole : {&smoother, &batch}) {
    EXPECT_GT(whole->largest_in_outages, 0.2);
    EXPECT_LT(whole->largest_in_outages, 0.4);
    EXPECT_LT(whole->tilt_rms, 0.005 * kDegree);
    EXPECT_GT(whole->nees, 2.5);
    EXPECT_LT(whole->nees, 3.5);
  }
  EXPECT_GT(filter.largest_in_outages, 5.0 * batch.largest_in_outages);
  std::printf(
      "mean over %d seeds, filter / smoother / batch: largest horizontal error "
      "in outages %.2f / %.3f / %.3f m, tilt %.4f / %.4f / %.4f deg, NEES "
      "%.2f / %.2f / %.2f\n",
      kSeeds, filter.largest_in_outages, smoother.largest_in_outages,
      batch.largest_in_outages, filter.tilt_rms / kDegree,
      smoother.tilt_rms / kDegree, batch.tilt_rms / kDegree, filter.nees,
      smoother.nees, batch.nees);
}

}  // namespace
}  // namespace hindsight
