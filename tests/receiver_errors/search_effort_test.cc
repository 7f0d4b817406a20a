#include "receiver_errors/search_effort.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(SearchEffort, IsLeftUntilItIsSpent) {
  SearchEffort effort(100.0, nullptr);
  EXPECT_EQ(effort.left(), 100.0);
  effort.Spend(30);
  EXPECT_EQ(effort.left(), 70.0);
  EXPECT_FALSE(effort.IsSpent());
  effort.Spend(80);
  EXPECT_EQ(effort.left(), 0.0);
  EXPECT_TRUE(effort.IsSpent());
  EXPECT_FALSE(effort.stopped());
}

TEST(SearchEffort, IsNotLeftOnceWhoeverAskedEndsIt) {
  SearchEffort effort(100.0, [](double fraction) { return fraction < 0.5; });
  effort.Spend(40);
  EXPECT_EQ(effort.left(), 60.0);
  effort.Spend(20);
  EXPECT_TRUE(effort.stopped());
  EXPECT_TRUE(effort.IsSpent());
  EXPECT_EQ(effort.left(), 0.0);
}

}  // namespace
}  // namespace hindsight
