#include "base/text.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(FormatProbability, HasTwoDigitsAndMoreNearOne) {
  EXPECT_EQ(FormatProbability(0.00123), "0.12 %");
  EXPECT_EQ(FormatProbability(0.51), "51 %");
  EXPECT_EQ(FormatProbability(0.989), "99 %");
  EXPECT_EQ(FormatProbability(0.9961), "99.6 %");
  EXPECT_EQ(FormatProbability(0.99949), "over 99.9 %");
  EXPECT_EQ(FormatProbability(1.0), "over 99.9 %");
}

}  // namespace
}  // namespace hindsight
