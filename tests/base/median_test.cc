#include "base/median.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(Median, IsTheUpperOfTheTwoInTheMiddle) {
  EXPECT_EQ(Median(std::vector<double>{3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median(std::vector<double>{4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(Median(std::vector<long>{7}), 7);
  EXPECT_EQ(Median(std::vector<long>{5, 5, 9, 9}), 9);
}

TEST(Median, OfNoneIsZero) { EXPECT_EQ(Median(std::vector<double>()), 0.0); }

}  // namespace
}  // namespace hindsight
