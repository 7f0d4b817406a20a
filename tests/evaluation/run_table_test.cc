#include "evaluation/run_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/chi_square.h"
#include "evaluation/statistics.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

RunRecord Record(const std::string& method, std::uint64_t seed, double value) {
  RunRecord record;
  record.labels = {"case", method};
  record.seed = seed;
  record.values = {{"x", value}};
  return record;
}

/// The series "e" of some runs.
SeriesFold FoldOf(const std::vector<std::vector<double>>& times,
                  const std::vector<std::vector<double>>& values) {
  SeriesFold sum = FoldOfRun(times[0], {{"e", values[0]}});
  for (std::size_t i = 1; i < times.size(); ++i) {
    sum = Combine(sum, FoldOfRun(times[i], {{"e", values[i]}}));
  }
  return sum;
}

TEST(RunCell, StatisticsAreOverRunsAtTheTimesThatAllHave) {
  const RunRecord a = Record("m", 1, 1.0);
  const RunRecord b = Record("m", 2, 3.0);
  const RunCell cell({&a, &b}, FoldOf({{0.0, 1.0, 2.0}, {1.0, 2.0, 3.0}},
                                      {{1.0, 2.0, 3.0}, {4.0, 7.0, 9.0}}));
  EXPECT_THAT(cell.Values("x"), ElementsAre(1.0, 3.0));
  EXPECT_THAT(cell.t(), ElementsAre(1.0, 2.0));
  EXPECT_THAT(cell.Curve("e", SeriesFold::Mean), ElementsAre(3.0, 5.0));
  EXPECT_DOUBLE_EQ(cell.Curve("e", SeriesFold::Rms)[0], std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(cell.Curve("e", SeriesFold::Deviation)[1], std::sqrt(8.0));
  EXPECT_EQ(OfCurve(Largest, SeriesFold::Mean)(cell, "e"), 5.0);
  EXPECT_EQ(OfCurve(Largest, SeriesFold::Mean, {.to = 1.5})(cell, "e"), 3.0);
  EXPECT_THAT(cell.Curve("none", SeriesFold::Mean), IsEmpty());
}

TEST(RunCell, RunsWithoutAnAnswerAreCountedAlone) {
  RunRecord a = Record("m", 1, 1.0);
  RunRecord b = Record("m", 2, 100.0);
  a.grade = Grade::kUsable;
  b.grade = Grade::kUnusable;
  b.Fail("wrong");
  const RunCell cell({&a, &b});
  EXPECT_EQ(cell.runs(), 2);
  EXPECT_EQ(cell.answered(), 1);
  EXPECT_EQ(cell.failed(), 1);
  EXPECT_EQ(cell.graded(Grade::kUsable), 1);
  EXPECT_EQ(cell.graded(Grade::kDoubtful), 0);
  EXPECT_EQ(cell.graded(Grade::kUnusable), 1);
  EXPECT_THAT(cell.Values("x"), ElementsAre(1.0));
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
  RunRecord record = Record("m", 1, 1.0);
  record.values = {{"states", 3.0}};
  const RunCell cell(
      {&record}, FoldOf({{0.0, 1.0, 2.0, 3.0}},
                        {{bounds.lower - 0.1, 3.0, bounds.upper + 0.1, 3.0}}));
  EXPECT_EQ(AneesOutside(cell, "e"), 0.5);
  StudyTable table = {"cells", {"method"}};
  table.AddAneesBounds();
  EXPECT_EQ(table.figures[0].reduce(cell, ""), bounds.lower);
  EXPECT_EQ(table.figures[1].reduce(cell, ""), bounds.upper);
}

TEST(StudyTable, FiguresAreByCellInOrderOfAppearance) {
  StudyTable table = {"cells", {"case", "method"}};
  table.Add({{"x_least", kPlain, OfRuns(Least), "x"},
             {"x", kPlain, OfRuns(Largest)},
             FailedFigure()});
  table.curves = {{"mean", kPlain, "e", SeriesFold::Mean}};
  std::vector<RunRecord> records = {Record("b", 1, 1.0), Record("a", 1, 2.0),
                                    Record("b", 2, 3.0)};
  records.push_back(records[0]);
  records.back().table = 1;
  CellFolds folds;
  folds[{0, {"case", "b"}}] = FoldOf({{0.0}, {0.0}}, {{4.0}, {6.0}});
  const std::vector<FigureRow> rows = Summarize(table, 0, records, folds);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].labels.back(), "b");
  EXPECT_EQ(rows[0].runs, 2);
  EXPECT_THAT(rows[0].curves[0], ElementsAre(5.0));
  EXPECT_EQ(FigureOf(table, rows[0], "x"), 3.0);
  EXPECT_EQ(FigureOf(table, rows[0], "x_least"), 1.0);
  EXPECT_EQ(FigureOf(table, rows[1], "failed"), 0.0);
  EXPECT_EQ(FigureOf(table, rows[1], "y"), std::nullopt);
}

TEST(StudyTable, MeasuresARunAndLeavesOutWhatItDoesNotTell) {
  StateErrors errors;
  errors.t = {0.0, 1.0, 2.0};
  errors.attitude.e = {{3.0, 4.0, 0.0}, {0.0, 0.0, 2.0}, {0.0, 0.0, 5.0}};
  errors.attitude.sigma.assign(3, Eigen::Vector3d::Ones());
  errors.attitude.nees = {1.0, 2.0, 6.0};
  const auto attitude = &StateErrors::attitude;
  StudyTable table = {"cells", {"method"}};
  table.Add({Measured("level", kPlain, Rms, OfPart(attitude, LevelRms)),
             Measured("late", kPlain, Mean,
                      OfPart(attitude, MeanNees, {.from = 0.5, .to = 1.5})),
             Measured("place", kMetres, Rms,
                      OfPart(&StateErrors::position, TotalRms))});
  table.series = {{"down", [](const auto& e) { return e.attitude.Down(); }},
                  {"north", [](const auto& e) { return e.position.Down(); }}};
  RunRecord record;
  table.Record(errors, &record);
  EXPECT_DOUBLE_EQ(record.Find("level").value(), std::sqrt(25.0 / 3.0));
  EXPECT_EQ(record.Find("late"), 2.0);
  EXPECT_EQ(record.Find("place"), std::nullopt);
  EXPECT_EQ(record.t, errors.t);
  EXPECT_THAT(record.series.at("down"), ElementsAre(0.0, 2.0, 5.0));
  EXPECT_FALSE(record.series.contains("north"));
}

TEST(StudyTable, AxesHaveAFigureEach) {
  StudyTable table = {"cells", {"method"}};
  table.AddAxes({"max", kMetres, OfRuns(Largest), "position"});
  ASSERT_EQ(table.figures.size(), 3u);
  EXPECT_EQ(table.figures[1].name, "max_e");
  EXPECT_EQ(table.figures[1].quantity, "position_e");
}

}  // namespace
}  // namespace hindsight
