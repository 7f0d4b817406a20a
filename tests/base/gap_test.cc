#include "base/gap.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(Gap, IsMoreThanFiveMedianSpacings) {
  EXPECT_DOUBLE_EQ(LongestSpacingWithoutGap({2.0, 2.0, 30.0, 2.0, 1.0}), 10.0);
}

TEST(Gap, NoSpacingsHaveNone) {
  EXPECT_DOUBLE_EQ(LongestSpacingWithoutGap({}), 0.0);
}

}  // namespace
}  // namespace hindsight
