#include "problems/linearisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "support/in_flight.h"
#include "support/mean_nees.h"

namespace hindsight {
namespace {

constexpr const char* kMethods[] = {"ekf", "rts", "two_filter", "iterated",
                                    "batch"};

/// Root of a third of the attitude's mean normalised squared error; one is
/// right.
double AttitudeSigmas(const Dataset& dataset, const Solution& solution) {
  return std::sqrt(MeanNees(dataset, solution, BlockKind::kAttitude) / 3.0);
}

/// What the verdict calls usable has right sigmas, and what is linearised from
/// a bad start too far off is not usable.
TEST(Linearisation, FromABadStartFalselySureSmoothersAreNotUsable) {
  const PerfectRecording flight(InFlightAlignment());
  int refused = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    for (const double heading : {120.0, 175.0}) {
      for (const ErrorDefinition error :
           {ErrorDefinition::kNavigation, ErrorDefinition::kLeftInvariant}) {
        Dataset dataset = flight.Realize(seed);
        GiveBadStart({10.0 * kDegree, heading * kDegree}, seed, &dataset);
        ReconstructionOptions options;
        options.error = error;
        Reconstruction reconstruction(dataset, options);
        for (const std::string method : kMethods) {
          const Solution solution = reconstruction.Run(method);
          const double sigmas = AttitudeSigmas(dataset, solution);
          SCOPED_TRACE(::testing::Message()
                       << method << " " << ErrorName(error) << " " << heading
                       << " deg, seed " << seed << ": " << sigmas << " sigmas, "
                       << solution.verdict);
          if (method == "iterated" || method == "batch") {
            EXPECT_TRUE(solution.usable());
          }
          if (solution.usable()) {
            EXPECT_LT(sigmas, 4.0);
          } else {
            EXPECT_GT(sigmas, 2.0);
            ++refused;
          }
        }
      }
    }
  }
  // All smoothers, at least.
  EXPECT_GE(refused, 16);
}

TEST(Linearisation, TheEvidenceNamesTheCure) {
  const PerfectRecording flight(InFlightAlignment());
  Dataset dataset = flight.Realize(1);
  GiveBadStart({10.0 * kDegree, 120.0 * kDegree}, 1, &dataset);
  ReconstructionOptions options;
  options.error = ErrorDefinition::kLeftInvariant;
  options.method = "rts";
  const Solution solution = Solve(dataset, options);
  EXPECT_FALSE(solution.usable());
  const auto found =
      std::find_if(solution.evidence.begin(), solution.evidence.end(),
                   [](const Evidence& e) { return e.rule == "linearisation"; });
  ASSERT_NE(found, solution.evidence.end()) << solution.verdict;
  EXPECT_EQ(AsAlternatives(found->better_methods), "iterated or batch");
  options.method = "ekf";
  EXPECT_TRUE(Solve(dataset, options).usable());
}

TEST(Linearisation, FromAnAlignedStartEveryMethodIsUsable) {
  const PerfectRecording flight(InFlightAlignment());
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Dataset dataset = flight.Realize(seed);
    Reconstruction reconstruction(dataset, {});
    for (const std::string method : kMethods) {
      const Solution solution = reconstruction.Run(method);
      EXPECT_TRUE(solution.usable()) << method << ": " << solution.verdict;
    }
  }
}

}  // namespace
}  // namespace hindsight
