#include "problems/outlier_rows.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hindsight {
namespace {

/// A fix a second: '.' is one that is believed, 'x' an outlier, ' ' none.
RowAtGap LongestOf(const std::string& text) {
  std::vector<TakenFix> fixes;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != ' ') {
      fixes.push_back({static_cast<double>(k), text[k] == 'x'});
    }
  }
  return LongestRowAtGap(fixes);
}

TEST(OutlierRows, AmongBelievedFixesAreNotAtAGap) {
  EXPECT_EQ(LongestOf("").count, 0);
  EXPECT_EQ(LongestOf("..........").count, 0);
  EXPECT_EQ(LongestOf("...xxxx...").count, 0);
}

TEST(OutlierRows, AreAtAGapAtItsBeginAndAtItsEnd) {
  const RowAtGap before = LongestOf("......xxx          .......");
  EXPECT_EQ(before.count, 3);
  EXPECT_EQ(before.begin, 6.0);
  EXPECT_EQ(before.end, 8.0);
  const RowAtGap behind = LongestOf("......          xx.......");
  EXPECT_EQ(behind.count, 2);
  EXPECT_EQ(behind.begin, 16.0);
}

TEST(OutlierRows, BeginAndEndOfTheRecordingAreGaps) {
  EXPECT_EQ(LongestOf("xx.....").count, 2);
  EXPECT_EQ(LongestOf(".....xxx").count, 3);
}

TEST(OutlierRows, AGapPartsARow) {
  // Three and two, not five.
  EXPECT_EQ(LongestOf("......xxx          xx.......").count, 3);
}

TEST(OutlierRows, FiveSpacingsAreNoGap) {
  EXPECT_EQ(LongestOf("......xx    .......").count, 0);
  EXPECT_EQ(LongestOf("......xx     .......").count, 2);
}

}  // namespace
}  // namespace hindsight
