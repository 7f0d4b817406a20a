#include "problems/outlier_rows.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "measurements/sensor_kind.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TestProblem;
using testing::TestProblemOptions;

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

/// Doubts of two sensors, the first of positions, with fixes as of LongestOf; the second of
/// positions or of velocities.
std::vector<Evidence> DoubtsOf(const std::string& first,
                               const std::string& second, bool are_positions) {
  TestProblem problem = MakeProblem(TestProblemOptions());
  problem.sensors[1].kind = are_positions ? &PositionKind() : &VelocityKind();
  std::vector<ResidualRecord> residuals;
  for (const int sensor : {0, 1}) {
    const std::string& text = sensor == 0 ? first : second;
    for (std::size_t k = 0; k < text.size(); ++k) {
      ResidualRecord r;
      r.sensor = sensor;
      r.t = static_cast<double>(k);
      r.accepted = true;
      r.weight = text[k] == 'x' ? 0.1 : 1.0;
      residuals.push_back(r);
    }
  }
  std::vector<Evidence> doubts;
  DoubtOutliersAtGaps(problem.MakeTimeline(), residuals, &doubts);
  return doubts;
}

/// Nothing comes behind it that would tell who is right.
TEST(OutlierRows, TheLastFixOfTheOnlySensorOfPositionsIsDoubtful) {
  const std::vector<Evidence> doubts = DoubtsOf(".........x", "", false);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].grade, Grade::kDoubtful);
  EXPECT_EQ(doubts[0].what.find("the last fix of gnss, at 9.0 s"), 0u);
  EXPECT_TRUE(DoubtsOf("x..x....x.", "", false).empty());
  // Where velocities are measured no slow drift goes unseen.
  EXPECT_TRUE(DoubtsOf(".........x", "..........", false).empty());
  EXPECT_TRUE(DoubtsOf(".........x", "..........", true).empty());
  EXPECT_EQ(DoubtsOf("xx........", "..........", true).size(), 1u);
}

/// What errs alike, and what has ended before, contradicts nothing.
TEST(OutlierRows, TheLastFixesOfAllSensorsOfPositionsAreDoubtful) {
  EXPECT_EQ(DoubtsOf(".........x", ".........x", true).size(), 2u);
  EXPECT_EQ(DoubtsOf(".........x", "....", true).size(), 1u);
  EXPECT_TRUE(DoubtsOf(".........x", ".....", true).empty());
}

}  // namespace
}  // namespace hindsight
