#include "filters/heading_profile.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::TypicalLayout;

class WidenHeadingTest : public ::testing::Test {
 protected:
  WidenHeadingTest()
      : layout_(TypicalLayout()),
        heading_(layout_.Find(BlockKind::kAttitude)->offset + 2),
        P_(layout_.dim(), 1) {
    ErrorMatrix P = ErrorMatrix::Identity(layout_.dim(), layout_.dim()) * 0.25;
    P(heading_, heading_) = 0.01;
    P(0, heading_) = P(heading_, 0) = 0.02;
    P_.Set(0, P);
  }

  ErrorMatrix Widened(double curvature) const {
    CovarianceSeries P = P_;
    WidenHeading(layout_, {.curvature = curvature}, &P);
    return P.Get(0);
  }

  ErrorLayout layout_;
  int heading_;
  CovarianceSeries P_;
};

TEST_F(WidenHeadingTest, LeavesWhatIsCredible) {
  EXPECT_EQ(Widened(1.0), P_.Get(0));
  EXPECT_EQ(Widened(0.8), P_.Get(0));
}

TEST_F(WidenHeadingTest, IsTheSandwichAndKeepsTheRegressionOnTheHeading) {
  const ErrorMatrix P = Widened(0.7);
  EXPECT_NEAR(P(heading_, heading_), 0.01 / 0.49, 1e-9);
  EXPECT_NEAR(P(0, heading_) / P(heading_, heading_), 2.0, 1e-6);
  // What the heading does not explain of it stays.
  EXPECT_NEAR(P(0, 0) - 2.0 * P(0, heading_), 0.25 - 0.04, 1e-7);
  EXPECT_EQ(P(1, 1), 0.25);
}

TEST_F(WidenHeadingTest, KnowsNothingWhereAllIsNoise) {
  EXPECT_NEAR(Widened(0.0)(heading_, heading_), kPi * kPi / 3.0, 1e-6);
}

TEST_F(WidenHeadingTest, KnowsNoLessThanThePrior) {
  CovarianceSeries P = P_;
  WidenHeading(layout_, {.curvature = 0.0, .open = 0.04}, &P);
  EXPECT_NEAR(P.Get(0)(heading_, heading_), 0.04, 1e-9);
  WidenHeading(layout_, {.curvature = 0.0, .open = 0.01}, &P);
  EXPECT_NEAR(P.Get(0)(heading_, heading_), 0.04, 1e-9);
}

}  // namespace
}  // namespace hindsight
