#include "problems/papers/alignment_trial.h"

#include <gtest/gtest.h>

#include "base/chi_square.h"
#include "base/units.h"
#include "support/in_flight.h"
#include "support/study.h"

namespace hindsight {
namespace {

TEST(AlignmentTrial, TheBatchAfterAlignmentIsConsistentOverTheWholeInterval) {
  constexpr int kRuns = 40;
  const PerfectRecording flight(InFlightAlignment(1.0));
  const Recording recording = [&](std::uint64_t seed) {
    Dataset dataset = flight.Realize(seed);
    MountAnywhere(seed, &dataset);
    return dataset;
  };
  const Trial trial = AlignmentTrial(kFirstManoeuvre + 10.0);
  const StudyResult all =
      testing::RunStudy({"",
                         {},
                         {Under({"velocity"}, AlignmentTable())},
                         {{{"1 Hz"}, [&] { return recording; }, trial}}},
                        {.runs = kRuns, .first_seed = 5001});
  ASSERT_EQ(all.rows[0].size(), 2u);
  const std::vector<std::string> batch = {"1 Hz", "velocity_alignment_batch"};
  EXPECT_EQ(testing::ValueOf(all, batch, "failed"), 0);
  // A mean over epochs scatters no more than that of one epoch.
  const Interval bounds = AneesBounds(kRuns, 3, 0.999);
  const double anees = testing::ValueOf(all, batch, "anees");
  EXPECT_TRUE(bounds.Contains(anees)) << anees;
  EXPECT_EQ(testing::ValueOf(all, batch, "anees_bound_lower"),
            AneesBounds(kRuns, 3, 0.95).lower);
  EXPECT_LT(testing::ValueOf(all, batch, "anees_outside"), 0.5);
}

}  // namespace
}  // namespace hindsight
