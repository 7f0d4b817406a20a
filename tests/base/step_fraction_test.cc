#include "base/step_fraction.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(StepFraction, OfOnePassExpectsAnother) {
  StepFraction step;
  step.Take(1.0, 0.25);
  EXPECT_DOUBLE_EQ(step.now(), 0.125);
  step.Take(4.0, 1.0);
  EXPECT_DOUBLE_EQ(step.now(), 0.5);
}

/// Three passes of ten seconds, with batches of a tenth of one between them: after
/// each as much is left as one takes, however many short ones there were.
TEST(StepFraction, TellsTimeLeftBesideShortPasses) {
  StepFraction step;
  double t = 0.0;
  for (int pass = 1; pass <= 3; ++pass) {
    for (double fraction = 0.0; fraction <= 1.0; fraction += 0.125) {
      step.Take(t + 10.0 * fraction, fraction);
    }
    t += 10.0;
    const double left = t * (1.0 - step.now()) / step.now();
    EXPECT_NEAR(left, 10.0, 0.5) << pass;
    for (int batch = 0; batch < 5; ++batch) {
      for (const double fraction : {0.0, 0.5, 1.0}) {
        step.Take(t + 0.1 * fraction, fraction);
      }
      t += 0.1;
    }
  }
}

TEST(StepFraction, FallsWhereAPassIsLonger) {
  StepFraction step;
  step.Take(1.0, 1.0);
  step.Take(2.0, 0.1);
  EXPECT_LT(step.now(), 0.5);
  EXPECT_DOUBLE_EQ(step.most(), 0.5);
}

TEST(StepFraction, KnowsNothingAtItsBegin) {
  StepFraction step;
  step.Take(0.0, 0.0);
  EXPECT_EQ(step.now(), 0.0);
  EXPECT_EQ(step.most(), 0.0);
}

}  // namespace
}  // namespace hindsight
