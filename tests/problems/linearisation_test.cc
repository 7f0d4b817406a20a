#include "problems/linearisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "problems/forward_stage.h"
#include "problems/reconstruction.h"
#include "support/in_flight.h"
#include "support/mean_nees.h"
#include "support/seed_count.h"

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
  EXPECT_GE(refused, 1);
}

/// A tunnel whose first fix comes after 500 s, with the forward speed alone.
Scenario ForwardTunnel() {
  return FindScenario("tunnel_survey", {"path=straight", "noise=density",
                                        "aiding.odometer.form=forward"});
}

TEST(Linearisation, TheEvidenceNamesTheCure) {
  ReconstructionOptions options;
  options.method = "rts";
  const Solution solution = Solve(Simulate(ForwardTunnel(), 1), options);
  EXPECT_FALSE(solution.usable());
  const auto found =
      std::find_if(solution.evidence.begin(), solution.evidence.end(),
                   [](const Evidence& e) { return e.rule == "linearisation"; });
  ASSERT_NE(found, solution.evidence.end()) << solution.verdict;
  EXPECT_EQ(AsAlternatives(found->better_methods), "iterated or batch");
}

/// Passes of which covariances are not found lead where all of them would.
TEST(Linearisation, RestsWherePassesWithCovariancesDo) {
  const PerfectRecording flight(InFlightAlignment());
  Dataset dataset = flight.Realize(1);
  GiveBadStart({10.0 * kDegree, 120.0 * kDegree}, 1, &dataset);
  ForwardStage stage(dataset, {});
  stage.Run();
  Problem problem = stage.problem();
  std::vector<State> states = stage.smoothed().states;
  const Rested rested = SmoothUntilItRests(states, &problem, nullptr);
  ASSERT_GT(rested.passes, 2);
  EXPECT_LT(rested.step, rested.first);
  SmoothedTrajectory last;
  problem = stage.problem();
  for (int pass = 0; pass < rested.passes; ++pass) {
    last = SmoothRts(RunLinearizedFilter(states, &problem));
    states = last.states;
  }
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_EQ(rested.trajectory.states[k].p_e, states[k].p_e) << k;
    EXPECT_EQ(rested.trajectory.P.Get(k), last.P.Get(k)) << k;
  }
}

TEST(Linearisation, AFilterThatEndsRightIsNotBlamedForItsStart) {
  const PerfectRecording flight(InFlightAlignment());
  Dataset dataset = flight.Realize(1);
  GiveBadStart({10.0 * kDegree, 120.0 * kDegree}, 1, &dataset);
  ReconstructionOptions options;
  options.error = ErrorDefinition::kLeftInvariant;
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

/// A hand whose first heading is off by 5 deg: what the filter of the first
/// seconds was linearised about is wrong by several sigmas of what the whole
/// interval knows there.
TEST(Linearisation, AStartThatTheIntervalKnowsBetterIsLinearisedAboutThat) {
  const PerfectRecording recording(FindScenario("test_hand", {}));
  const int seeds = testing::SeedCount(30, 100);
  constexpr double kBeginning = 15.0;  // [s]
  double nees = 0.0;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = 81000 + static_cast<std::uint64_t>(i);
    Dataset dataset = recording.Realize(seed);
    ReconstructionOptions options;
    for (double t = 1.0; t < kBeginning; ++t) options.node_times.push_back(t);
    Reconstruction reconstruction(dataset, options);
    for (const std::string method : {"rts", "two_filter"}) {
      Solution solution = reconstruction.Run(method);
      EXPECT_TRUE(solution.usable()) << seed << ": " << solution.verdict;
      solution = reconstruction.Sample(solution, options.node_times);
      nees += MeanNees(dataset, solution, BlockKind::kAttitude) /
              (2.0 * static_cast<double>(seeds));
    }
  }
  // The mean of 15 s of three angles scatters by about 1.5.
  EXPECT_NEAR(nees, 3.0, 3.0 * 1.5 / std::sqrt(seeds));
}

/// What the interval learns after the first 40 s does not cure their start.
TEST(Linearisation, AFarFixCuresNoStart) {
  const PerfectRecording tunnel(ForwardTunnel());
  int wrong = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Dataset dataset = tunnel.Realize(seed);
    Reconstruction reconstruction(dataset, {});
    for (const std::string method : {"rts", "two_filter"}) {
      const Solution solution = reconstruction.Run(method);
      if (MeanNees(dataset, solution, BlockKind::kPosition) > 25.0) ++wrong;
      EXPECT_FALSE(solution.usable()) << seed << ": " << solution.verdict;
    }
  }
  EXPECT_GE(wrong, 1);
}

}  // namespace
}  // namespace hindsight
