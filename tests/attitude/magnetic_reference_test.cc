#include "attitude/magnetic_reference.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

constexpr double kReferenceStep = 0.01;
constexpr double kMoving = 1.0;

bool Feed(double seconds, double norm, double dip, double rate,
          MagneticReference* reference) {
  bool accepted = false;
  for (int i = 0; i < static_cast<int>(seconds / kReferenceStep); ++i) {
    accepted = reference->Accept(kReferenceStep, norm, dip, rate);
  }
  return accepted;
}

TEST(MagneticReference, LearnsTheFirstSteadyField) {
  MagneticReference reference({});
  EXPECT_TRUE(Feed(4.0, 50.0, 1.1, 0.0, &reference));
  EXPECT_FALSE(reference.is_known());
  Feed(2.0, 50.0, 1.1, 0.0, &reference);
  EXPECT_TRUE(reference.is_known());
  EXPECT_NEAR(reference.norm(), 50.0, 1e-9);
  EXPECT_NEAR(reference.dip(), 1.1, 1e-9);
}

TEST(MagneticReference, RejectsByNormAndByDip) {
  MagneticReference reference({});
  Feed(6.0, 50.0, 1.1, 0.0, &reference);
  EXPECT_FALSE(Feed(1.0, 57.0, 1.1, kMoving, &reference));
  EXPECT_TRUE(Feed(1.0, 50.0, 1.1, kMoving, &reference));
  EXPECT_FALSE(Feed(1.0, 50.0, 0.8, kMoving, &reference));
}

TEST(MagneticReference, ADisturbanceAtRestNeverBecomesTheReference) {
  MagneticReference reference({});
  Feed(6.0, 50.0, 1.1, 0.0, &reference);
  EXPECT_FALSE(Feed(100.0, 70.0, 0.9, 0.0, &reference));
  // It follows by at most the limit for as long as the smoothing takes.
  EXPECT_NEAR(reference.norm(), 50.0, 0.1 * 50.0 * 0.05 / 20.0);
}

TEST(MagneticReference, AFieldThatStaysInMotionDoes) {
  MagneticReference reference({});
  Feed(6.0, 50.0, 1.1, 0.0, &reference);
  EXPECT_TRUE(Feed(25.0, 70.0, 0.9, kMoving, &reference));
  EXPECT_NEAR(reference.norm(), 70.0, 0.1);
}

TEST(MagneticReference, AKnownReferenceHoldsFromTheFirstReading) {
  MagneticReferenceOptions options;
  options.norm = 50.0;
  options.dip = 1.1;
  MagneticReference reference(options);
  EXPECT_FALSE(Feed(1.0, 70.0, 1.1, 0.0, &reference));
}

}  // namespace
}  // namespace hindsight
