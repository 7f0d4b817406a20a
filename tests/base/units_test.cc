#include "base/units.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(Units, ConversionsOfTheField) {
  EXPECT_NEAR(kDegreePerSqrtHour, 2.9089e-4, 1e-8);  // deg/sqrt(h)
  EXPECT_NEAR(180.0 * kDegree, kPi, 1e-15);
  EXPECT_NEAR(60.0 * kArcMinute, kDegree, 1e-17);
  EXPECT_NEAR(kKnot, 0.514444, 1e-6);
  EXPECT_EQ(1e5 * kMilliGal, 1.0);
}

}  // namespace
}  // namespace hindsight
