#include <gtest/gtest.h>

#include "evaluation/chi_square.h"
#include "problems/montecarlo.h"
#include "simulation/calibration_drive.h"

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
  const PerfectRecording recording(CalibrationDrive(kDuration));
  MonteCarloOptions options;
  options.runs = kRuns;
  for (double t = 20.0; t < kDuration; t += 20.0) {
    options.node_times.push_back(t);
  }
  options.anees_bounds = [](int runs, int dim) {
    const Interval bounds = AneesBounds(runs, dim, 0.999);
    return std::pair(bounds.lower, bounds.upper);
  };
  const MonteCarloResult result = RunMonteCarlo(
      {{"",
        [&recording](std::uint64_t seed) { return recording.Realize(seed); },
        {"batch"}}},
      options);
  EXPECT_EQ(result.dim, 33);
  // 18 constants; one in ten thousand may be outside.
  const Interval bounds = AneesBounds(kRuns, 1, 0.9999);
  const MethodStatistics& batch = result.methods[0];
  ASSERT_EQ(batch.constants.size(), 18u);
  EXPECT_EQ(batch.failed, 0);
  for (const ConstantStatistics& c : batch.constants) {
    EXPECT_TRUE(bounds.Contains(c.anees))
        << c.name << ": " << c.anees << " against " << bounds.lower << " to "
        << bounds.upper;
    EXPECT_LE(c.sigma, c.prior_sigma * (1.0 + 1e-9)) << c.name;
  }
  const Interval whole = AneesBounds(kRuns, result.dim, 0.9999);
  EXPECT_TRUE(whole.Contains(batch.anees_series.back()))
      << batch.anees_series.back();
  EXPECT_EQ(batch.t.size(), options.node_times.size());
}

}  // namespace
}  // namespace hindsight
