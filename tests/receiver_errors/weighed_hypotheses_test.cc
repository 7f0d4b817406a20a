#include "receiver_errors/weighed_hypotheses.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

/// One that has the vehicle `north` metres elsewhere.
WeighedHypothesis Elsewhere(double north, double weight) {
  constexpr int kDim = 9;
  WeighedHypothesis one;
  one.weight = weight;
  one.steps.resize(2);
  one.smoothed = ErrorTrajectory(kDim, one.steps.size());
  for (std::size_t k = 0; k < one.steps.size(); ++k) {
    one.smoothed[k].setZero();
    one.smoothed[k](0) = north;
  }
  return one;
}

/// What lies between two likely ones is told in their place only if it is about as
/// likely.
TEST(WeighedHypotheses, TheMostCentralIsALikelyOne) {
  EXPECT_EQ(MostCentral({Elsewhere(0.0, 0.38), Elsewhere(2.0, 0.37),
                         Elsewhere(1.0, 0.25)}),
            2u);
  EXPECT_EQ(MostCentral({Elsewhere(0.0, 0.48), Elsewhere(2.0, 0.47),
                         Elsewhere(1.0, 0.05)}),
            0u);
}

}  // namespace
}  // namespace hindsight
