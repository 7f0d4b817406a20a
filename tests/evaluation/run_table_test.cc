#include "evaluation/run_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/chi_square.h"
#include "evaluation/statistics.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

RunRecord Record(const std::string& method, std::uint64_t seed, double value,
                 std::vector<double> t, std::vector<double> series) {
  RunRecord record;
  record.labels = {"case", method};
  record.seed = seed;
  record.values = {{"x", value}};
  record.t = std::move(t);
  record.series["e"] = std::move(series);
  return record;
}

TEST(RunCell, StatisticsAreOverRunsAtTheTimesThatAllHave) {
  const RunRecord a = Record("m", 1, 1.0, {0.0, 1.0, 2.0}, {1.0, 2.0, 3.0});
  const RunRecord b = Record("m", 2, 3.0, {1.0, 2.0, 3.0}, {4.0, 7.0, 9.0});
  const RunCell cell({&a, &b});
  EXPECT_THAT(cell.Values("x"), ElementsAre(1.0, 3.0));
  EXPECT_THAT(cell.t(), ElementsAre(1.0, 2.0));
  EXPECT_THAT(cell.Curve("e", Mean), ElementsAre(3.0, 5.0));
  EXPECT_THAT(cell.Within(cell.Curve("e", Largest), {.from = 1.5}),
              ElementsAre(7.0));
  EXPECT_THAT(cell.Pooled("e", {.from = 2.0}), ElementsAre(3.0, 7.0, 9.0));
  EXPECT_THAT(cell.Curve("none", Mean), IsEmpty());
}

TEST(RunCell, RunsWithoutAnAnswerAreCountedAlone) {
  RunRecord a = Record("m", 1, 1.0, {0.0}, {1.0});
  RunRecord b = Record("m", 2, 100.0, {}, {});
  a.grade = Grade::kUsable;
  b.grade = Grade::kUnusable;
  b.failed = true;
  b.answered = false;
  const RunCell cell({&a, &b});
  EXPECT_EQ(cell.runs(), 2);
  EXPECT_EQ(cell.answered(), 1);
  EXPECT_EQ(cell.failed(), 1);
  EXPECT_THAT(cell.grades(), ElementsAre(1, 0, 1));
  EXPECT_THAT(cell.Values("x"), ElementsAre(1.0));
  EXPECT_THAT(cell.Curve("e", Mean), ElementsAre(1.0));
}

TEST(RunStatistics, RanksKeepWhatIsInfinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Rank({infinity, 1.0, 2.0, 3.0}, 0.5), 2.0);
  EXPECT_EQ(Rank({infinity, 1.0, 2.0, 3.0}, 0.95), infinity);
  EXPECT_TRUE(std::isnan(Rank({}, 0.5)));
  EXPECT_DOUBLE_EQ(StandardDeviation({1.0, 3.0}), std::sqrt(2.0));
  EXPECT_EQ(StandardDeviation({5.0}), 0.0);
  EXPECT_DOUBLE_EQ(Rms({3.0, 4.0}), std::sqrt(12.5));
}

TEST(RunStatistics, ShareOutsideCountsBothSides) {
  const Interval bounds = AneesBounds(1, 3, 0.95);
  RunRecord record = Record("m", 1, 1.0, {0.0, 1.0, 2.0, 3.0},
                            {bounds.lower - 0.1, 3.0, bounds.upper + 0.1, 3.0});
  record.values = {{"states", 3.0}};
  const RunCell cell({&record});
  EXPECT_EQ(AneesOutside(cell, "e", {}), 0.5);
  EXPECT_EQ(AneesOutside(cell, "e", {.from = 2.5}), 0.0);
  const Figure figure = AneesBoundFigure("", "");
  EXPECT_EQ(figure.terms[0].reduce(cell, "", {}), bounds.lower);
  EXPECT_EQ(figure.terms[1].reduce(cell, "", {}), bounds.upper);
}

TEST(StudyTable, FiguresAreByCellInOrderOfAppearance) {
  StudyTable table = {"cells", {"case", "method"}, {}, {}};
  table.figures = {Several("x", kPlain, "", "",
                           {{"least", "x", OfRuns<Least>},
                            {"largest", "x", OfRuns<Largest>}}),
                   FailedFigure()};
  table.curves = {{"mean", kPlain, "e", Mean}};
  std::vector<RunRecord> records = {Record("b", 1, 1.0, {0.0}, {4.0}),
                                    Record("a", 1, 2.0, {0.0}, {5.0}),
                                    Record("b", 2, 3.0, {0.0}, {6.0})};
  records.push_back(records[0]);
  records.back().table = 1;
  const std::vector<FigureRow> rows = Summarize(table, 0, records);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].labels.back(), "b");
  EXPECT_EQ(rows[0].runs, 2);
  EXPECT_THAT(rows[0].curves[0], ElementsAre(5.0));
  EXPECT_EQ(FigureOf(table, rows[0], "x_largest"), 3.0);
  EXPECT_EQ(FigureOf(table, rows[1], "failed"), 0.0);
  EXPECT_EQ(FigureOf(table, rows[1], "x"), std::nullopt);
}

}  // namespace
}  // namespace hindsight
