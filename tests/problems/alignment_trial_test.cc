#include "problems/alignment_trial.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "evaluation/chi_square.h"
#include "simulation/in_flight_alignment.h"

namespace hindsight {
namespace {

TEST(AlignmentTrial, TheBatchAfterAlignmentIsConsistentOverTheWholeInterval) {
  constexpr int kRuns = 40;
  const PerfectRecording flight(InFlightAlignment({.velocity_rate_hz = 1.0}));
  MonteCarloOptions options;
  options.runs = kRuns;
  options.first_seed = 5001;
  options.anees_bounds = [](int runs, int dim) {
    const Interval bounds = AneesBounds(runs, dim, 0.999);
    return std::pair(bounds.lower, bounds.upper);
  };
  const std::vector<AlignmentStatistics> all =
      TryAlignment({{"1 Hz",
                     [&](std::uint64_t seed) {
                       Dataset dataset = flight.Realize(seed);
                       MountAnywhere(seed, &dataset);
                       dataset.initial.alignment = AlignmentKind::kVelocity;
                       return dataset;
                     }}},
                   {.t_early = kFirstManoeuvre + 10.0,
                    .diverged_tilt = 2.0 * kDegree,
                    .diverged_heading = 10.0 * kDegree,
                    .last = 20.0},
                   options);
  ASSERT_EQ(all.size(), 2u);
  const AlignmentStatistics& batch = all.back();
  EXPECT_EQ(batch.name, "velocity_alignment_batch");
  EXPECT_EQ(batch.answered, kRuns);
  EXPECT_EQ(batch.failed, 0);
  // A mean over epochs scatters no more than that of one epoch.
  const Interval bounds = AneesBounds(kRuns, 3, 0.999);
  EXPECT_TRUE(bounds.Contains(batch.anees)) << batch.anees;
  EXPECT_EQ(batch.anees_lower, bounds.lower);
  EXPECT_LT(batch.anees_outside, 0.5);
}

}  // namespace
}  // namespace hindsight
