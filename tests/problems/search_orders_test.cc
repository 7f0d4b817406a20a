#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "base/random.h"
#include "earth/wgs84.h"
#include "problems/error_search.h"
#include "support/shuttle_flight.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::AntennaLeverArm;
using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

constexpr int kGnss = 0;
constexpr int kBarometer = 1;

/// A minute with a receiver and a barometer.
struct Flight {
  explicit Flight(bool heights_err, bool receiver_errs = true) {
    TestProblemOptions options;
    options.noise = TacticalNoise(true);
    options.layout = TypicalLayout(options.noise);
    options.errors = true;
    options.duration = 60.0;
    options.position_sigma = 0.5;
    test = MakeProblem(options, 3);
    test.sensors[kBarometer].name = "barometer";
    test.sensors[kBarometer].kind = &HeightKind();
    Random random(5);
    for (std::size_t k = 0; k < test.nodes.size(); ++k) {
      const State& x = test.truth[k];
      for (int i = 0; i < test.nodes[k].measurement_count; ++i) {
        Measurement& z = test.measurements[static_cast<std::size_t>(
            test.nodes[k].first_measurement + i)];
        if (z.sensor != kBarometer) continue;
        HeightFix height;
        height.sigma = 0.3;
        height.height =
            GeodeticFromEcef(x.p_e + x.q_eb * AntennaLeverArm()).height +
            height.sigma * random.Normal();
        if (heights_err && z.t > 15.0 && z.t < 31.0) height.height += 5.0;
        z.model = height;
      }
    }
    if (!receiver_errs) return;
    // Jumps by 30 m, and comes back in a straight line.
    for (Measurement& z : test.measurements) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || z.t < 20.5 || z.t >= 35.5) continue;
      fix->p_e += NedAxes(fix->p_e).col(0) * 2.0 * (35.5 - z.t);
    }
  }
  Problem Pose() const {
    return test.Pose(GateDecisions(test.measurements.size(), 1));
  }

  TestProblem test;
};

double FarthestFromTruth(const TestProblem& test,
                         const std::vector<State>& states) {
  double farthest = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    farthest = std::max(farthest, (states[k].p_e - test.truth[k].p_e).norm());
  }
  return farthest;
}

TEST(SearchOrders, PositionsAloneThenWhatWasLeftOut) {
  const Flight flight(true);
  const RobustBatchOptions options;
  ErrorSearch search(flight.Pose(), options, 1.0);
  ASSERT_TRUE(search.RunFromOne(kGnss, {kBarometer}, flight.test.truth));
  EXPECT_TRUE(search.HasErrors(kGnss));
  EXPECT_TRUE(search.HasErrors(kBarometer));
  const SearchDecisions decisions = search.Decisions();
  ASSERT_EQ(decisions.front().errors.size(), 1u);
  EXPECT_EQ(decisions.front().without, std::vector<int>{kBarometer});
  EXPECT_EQ(search.first_sensor(), kGnss);
  EXPECT_LT(FarthestFromTruth(flight.test, *search.states()), 1.5);
}

TEST(SearchOrders, AsDecidedBeginsWithThePositionsAloneToo) {
  const Flight flight(true);
  const RobustBatchOptions options;
  ErrorSearch search(flight.Pose(), options, 1.0);
  ASSERT_TRUE(search.RunFromOne(kGnss, {kBarometer}, flight.test.truth));
  const SearchDecisions decisions = search.Decisions();
  RobustBatchOptions decided;
  decided.decisions = &decisions;
  ErrorSearch again(flight.Pose(), decided, 1.0);
  again.RunAsDecided(flight.test.truth);
  ASSERT_TRUE(again.states().has_value());
  for (std::size_t k = 0; k < search.states()->size(); ++k) {
    EXPECT_LT(((*search.states())[k].p_e - (*again.states())[k].p_e).norm(),
              1e-6);
  }
}

/// What is found by the time is that the receiver errs to the end, or the IMU's velocity
/// steps: the barometer may in its place.
TEST(SearchOrders, NothingIsBelievedOfWhichTimeLeftOthersOut) {
  const Flight flight(true);
  int unbelieved = 0;
  for (const double end : {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45}) {
    RobustBatchOptions options;
    options.go_on = [end](double fraction) { return fraction < end; };
    ErrorSearch search(flight.Pose(), options, 1.0);
    search.Run(flight.test.truth);
    EXPECT_TRUE(search.ended());
    if (search.states()) {
      EXPECT_LT(FarthestFromTruth(flight.test, *search.states()), 3.0) << end;
      continue;
    }
    RobustBatchResult result = {.problem = flight.Pose()};
    search.Tell(&result);
    unbelieved += std::ranges::any_of(result.notes, [](const auto& one) {
      return one.find("not believed") != std::string::npos;
    });
  }
  EXPECT_GT(unbelieved, 0);
}

/// It would be taken at its word, or left out, for what another sensor was given.
TEST(SearchOrders, WhatIsLastIsAskedAlsoWhereNothingElseIsBelieved) {
  const Flight flight(true, false);
  RobustBatchOptions options;
  options.last = {kBarometer};
  ErrorSearch search(flight.Pose(), options, 1.0);
  search.Disbelieve("what was found", "a constant explains more");
  search.RunLast(flight.test.truth);
  EXPECT_FALSE(search.LeavesOut());
  EXPECT_TRUE(search.HasErrors(kBarometer));
}

TEST(SearchOrders, NothingIsSuspectedBesideHeightsThatAreHealthy) {
  const Flight flight(false);
  const RobustBatchOptions options;
  ErrorSearch search(flight.Pose(), options, 1.0);
  search.Run(flight.test.truth);
  EXPECT_TRUE(search.HasErrors(kGnss));
  EXPECT_TRUE(search.SuspectsBeside().empty());
}

}  // namespace
}  // namespace hindsight
