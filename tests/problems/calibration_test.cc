#include <gtest/gtest.h>

#include "base/chi_square.h"
#include "io/config/scenario_config.h"
#include "support/navigation_study.h"
#include "support/study.h"

namespace hindsight {
namespace {

/// Lever arms, time offsets, scale factors and mounting, all at once: each
/// constant's errors over its sigmas, and the whole state's.
TEST(Calibration, EveryConstantIsAsGoodAsItsSigma) {
#ifdef NDEBUG
  constexpr int kRuns = 8;
#else
  constexpr int kRuns = 2;
#endif
  constexpr double kDuration = 160.0;
  Scenario scenario = FindScenario("calibration");
  scenario.duration = kDuration;
  const PerfectRecording recording(scenario);
  const StudyResult result = testing::RunStudy(
      testing::NavigationStudy(recording,
                               {.methods = {"batch"}, .judged_every = 20.0}),
      {.runs = kRuns});
  EXPECT_EQ(testing::ValueOf(result, {"batch"}, "states"), 33);
  EXPECT_EQ(testing::ValueOf(result, {"batch"}, "failed"), 0);
  // 18 constants; one in ten thousand may be outside.
  const Interval bounds = AneesBounds(kRuns, 1, 0.9999);
  ASSERT_EQ(result.rows[kConstants].size(), 18u);
  for (const FigureRow& row : result.rows[kConstants]) {
    const auto value = [&](const char* name) {
      return testing::ValueOf(result, row.labels, name, kConstants);
    };
    EXPECT_TRUE(bounds.Contains(value("anees")))
        << row.labels[1] << ": " << value("anees") << " against "
        << bounds.lower << " to " << bounds.upper;
    EXPECT_LE(value("sigma"), value("prior_sigma") * (1.0 + 1e-9))
        << row.labels[1];
  }
  const Interval whole = AneesBounds(kRuns, 33, 0.9999);
  const FigureRow& batch = testing::RowOf(result, {"batch"});
  const double at_end = batch.curves.back().back();
  EXPECT_TRUE(whole.Contains(at_end)) << at_end;
  EXPECT_EQ(batch.t.size(), 7u);
}

}  // namespace
}  // namespace hindsight
