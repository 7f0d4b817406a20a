#include "problems/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "filters/forward_filter.h"
#include "io/config/scenario_config.h"
#include "problems/forward_stage.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

/// The fit of a recording about the states that it rests at, and by the tape about
/// those of a pass before.
struct BothFits {
  explicit BothFits(const Dataset& dataset) {
    ForwardStage stage(dataset, {});
    stage.Run();
    Problem problem = stage.problem();
    const std::vector<State> near =
        SmoothUntilItRests(stage.smoothed().states, &problem, {})
            .trajectory.states;
    const LinearTape tape = RunLinearizedFilter(near, &problem);
    const Rested rested = SmoothUntilItRests(near, &problem, {});
    step = rested.step;
    passes = rested.passes;
    const Relinearised anew = {
        .states = rested.trajectory.states,
        .variances = VariancesOf(problem.layout, rested.trajectory.P),
        .smoother = {}};
    own = JudgeFit(dataset, anew, &problem);
    by_near = JudgeFit(dataset, anew, near, tape, &problem, {});
  }

  double step = 0.0;
  int passes = 0;
  Fit own, by_near;
};

/// Of the normalised innovations.
double LargestDifference(const Fit& a, const Fit& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.innovations.size(); ++i) {
    largest =
        std::max(largest, (a.innovations[i].white - b.innovations[i].white)
                              .cwiseAbs()
                              .maxCoeff());
  }
  return largest;
}

TEST(Fit, ByATapeNearbyIsThatOfTheStatesThemselves) {
  const BothFits fits(Simulate(FindScenario("test_car", {}), 11));
  ASSERT_EQ(fits.passes, 1);
  ASSERT_LT(fits.step, Rested::kNegligibleStep);
  ASSERT_TRUE(fits.own.tested && fits.by_near.tested);
  ASSERT_EQ(fits.by_near.innovations.size(), fits.own.innovations.size());
  const double apart = LargestDifference(fits.own, fits.by_near);
  EXPECT_GT(apart, 0.0);  // or it was not judged by that tape
  EXPECT_LT(apart, 0.02);
  EXPECT_EQ(fits.by_near.explanations.size(), fits.own.explanations.size());
  EXPECT_FALSE(fits.by_near.contradiction);
}

TEST(Fit, OfWhatDoesNotFitIsJudgedAboutItsOwnStates) {
  Dataset dataset = Simulate(FindScenario("test_car", {}), 11);
  ApplyFault({FindFaultKind("scale"), "odometer", 1.05}, 11, &dataset);
  const BothFits fits(dataset);
  ASSERT_EQ(fits.by_near.innovations.size(), fits.own.innovations.size());
  EXPECT_EQ(LargestDifference(fits.own, fits.by_near), 0.0);
  EXPECT_TRUE(fits.by_near.contradiction);
}

}  // namespace
}  // namespace hindsight
