#ifndef HINDSIGHT_EVALUATION_RUN_TABLE_H_
#define HINDSIGHT_EVALUATION_RUN_TABLE_H_

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/series_fold.h"
#include "state/evidence.h"

namespace hindsight {

/// \file
/// The long table of a Monte Carlo comparison, a row a case, method and seed,
/// and what it says over the seeds. Quantities have names, SI units inside.

/// Processor time of a method alone [s]: the one quantity that two equal calls
/// do not give alike.
inline constexpr char kSeconds[] = "seconds";

/// What one method made of one run.
struct RunRecord {
  std::size_t table = 0;  ///< of the study, that it belongs to
  /// Case and method: a value for each label column of the table.
  std::vector<std::string> labels;
  std::uint64_t seed = 0;
  bool failed = false;   ///< counted as such
  bool answered = true;  ///< its values and series take part in the figures
  std::optional<Grade> grade;
  std::string refusal;  ///< what was wrong with the data, of a failed run
  /// Of the run as a whole, by name.
  std::vector<std::pair<std::string, double>> values;
  std::vector<double> t;  ///< of the series [s]
  /// By name, a value at every t. Of a table that folds them they are taken out
  /// of the record.
  std::map<std::string, std::vector<double>> series;

  /// Makes it a failed run without an answer; `what` was wrong with the data.
  void Fail(std::string what = "") {
    failed = true;
    answered = false;
    refusal = std::move(what);
  }
};

/// Closed span of time [s].
struct TimeRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  bool Contains(double t) const { return t >= from && t <= to; }
};

/// All runs of one case and method. What is asked for and was never recorded is
/// empty. Runs that were not answered take part in counts alone.
class RunCell {
 public:
  using Statistic = double (*)(const std::vector<double>&);

  /// At least one record; they share their labels and outlive the cell.
  /// `fold`: their series, where the records have none any more, or null.
  explicit RunCell(std::vector<const RunRecord*> records,
                   const SeriesFold* fold = nullptr);

  const std::vector<std::string>& labels() const { return all_[0]->labels; }
  int runs() const { return static_cast<int>(all_.size()); }
  int answered() const { return static_cast<int>(answered_.size()); }
  int failed() const;
  /// Runs graded usable, doubtful, not usable; all zero where none is graded.
  std::array<int, 3> grades() const;

  /// Of every run that has the value, in order of seeds.
  std::vector<double> Values(const std::string& name) const;
  /// Times at which every run has its series.
  const std::vector<double>& t() const { return t_; }
  /// A series of all runs within the span, run after run.
  std::vector<double> Pooled(const std::string& name,
                             const TimeRange& range = {}) const;
  /// A statistic over the runs at every t(): of folded series Mean or
  /// StandardDeviation.
  std::vector<double> Curve(const std::string& name, Statistic over_runs) const;
  /// The part of a curve that lies in the span.
  std::vector<double> Within(const std::vector<double>& curve,
                             const TimeRange& range) const;

 private:
  std::vector<const RunRecord*> all_;
  std::vector<const RunRecord*> answered_;
  const SeriesFold* fold_;
  std::vector<double> t_;
  /// Index into each answered run's series of every t_.
  std::vector<std::vector<std::size_t>> index_;
};

/// A unit as printed, and what it is in SI.
struct Unit {
  const char* name = "1";
  double scale = 1.0;
};
inline constexpr Unit kPlain = {};
inline constexpr Unit kMetres = {"m", 1.0};
inline constexpr Unit kDegrees = {"deg", kDegree};

/// One number of a cell: of the quantity's values, or of its series within a
/// span of time; NaN if there is none.
using Reduce = std::function<double(
    const RunCell& cell, const std::string& quantity, const TimeRange& range)>;

/// Over the values of the runs.
template <RunCell::Statistic statistic>
double OfRuns(const RunCell& cell, const std::string& quantity,
              const TimeRange&) {
  return statistic(cell.Values(quantity));
}
/// Over runs and times alike.
template <RunCell::Statistic statistic>
double OfAll(const RunCell& cell, const std::string& quantity,
             const TimeRange& range) {
  return statistic(cell.Pooled(quantity, range));
}
/// Over time of what it is over the runs at each.
template <RunCell::Statistic over_time, RunCell::Statistic over_runs>
double OfCurve(const RunCell& cell, const std::string& quantity,
               const TimeRange& range) {
  return over_time(cell.Within(cell.Curve(quantity, over_runs), range));
}
/// Two-sided bounds of the average over the answered runs of a normalised squared
/// error with as many degrees of freedom as their value `states`; NaN without.
Interval AneesBoundsOf(const RunCell& cell, double confidence = 0.95);
/// Share of the times at which that average of the quantity is outside of them.
double AneesOutside(const RunCell& cell, const std::string& quantity,
                    const TimeRange& range);

/// One number of a figure.
struct Term {
  std::string component;  ///< "n", "e", "d"; "" if it is the only one
  std::string quantity;
  Reduce reduce;
};
using Terms = std::vector<Term>;

/// One figure of a table, or some of a kind.
struct Figure {
  std::string name;  ///< "max_std"
  Unit unit;
  std::string title;   ///< over its column of the printed table; "": not there
  const char* format;  ///< of each term there
  Terms terms;
  TimeRange range = {};
  double factor = 1.0;     ///< in the printed table: 100 for a share in percent
  bool hide_zero = false;  ///< there
  int part = 0;            ///< of the printed table that it stands in
  bool is_repeatable = true;  ///< false: not the same in an equal call
  /// Any number of values in place of the terms, for JSON alone.
  std::function<std::vector<double>(const RunCell& cell)> list = {};
};

/// A figure of several terms.
Figure Several(const std::string& name, Unit unit, const std::string& title,
               const char* format, Terms terms, TimeRange range = {});
/// A figure of one term without a component.
Figure Single(const std::string& name, Unit unit, const std::string& title,
              const char* format, const std::string& quantity,
              const Reduce& reduce);
/// The same, of the quantity of that name.
inline Figure Single(const std::string& name, Unit unit,
                     const std::string& title, const char* format,
                     const Reduce& reduce) {
  return Single(name, unit, title, format, name, reduce);
}
/// A share, printed in percent.
Figure Share(const std::string& name, const std::string& title,
             const std::string& quantity, const Reduce& reduce);
/// Lower and upper of AneesBoundsOf.
Figure AneesBoundFigure(const char* title, const char* format,
                        double confidence = 0.95);

/// A figure against time.
struct FigureCurve {
  std::string name;
  Unit unit;
  std::string quantity;
  RunCell::Statistic over_runs;
};

/// What is known of one kind of record: its label columns, its figures.
struct StudyTable {
  std::string name;                 ///< "cells"
  std::vector<std::string> labels;  ///< columns, the method last
  std::vector<Figure> figures;
  std::vector<FigureCurve> curves;
  /// Figures and curves take no more of the series than mean and deviation over
  /// the runs, so that these are kept in place of all runs' series.
  bool folds_series = false;
};

/// A row of figures.
struct FigureRow {
  std::vector<std::string> labels;
  int runs = 0;
  int failed = 0;
  /// By figure of the table, by term, SI; NaN: does not exist.
  std::vector<std::vector<double>> values;
  std::vector<double> t;
  std::vector<std::vector<double>> curves;  ///< by curve of the table, SI
};

/// The figures of the records that belong to the table of that index, a row a
/// cell in the order of their first appearance; their series, of a table that
/// folds them, are in `folds`.
std::vector<FigureRow> Summarize(const StudyTable& table, std::size_t index,
                                 std::span<const RunRecord> records,
                                 const CellFolds& folds = {});

/// The table with these label columns before its own.
StudyTable Under(std::vector<std::string> columns, StudyTable table);

/// One number of a table's rows: a term of a figure.
struct FigureColumn {
  std::string name;  ///< component included, "max_std_n"
  const Figure* figure;
  std::size_t figure_index;
  std::size_t term_index;

  double SiOf(const FigureRow& row) const {
    return row.values[figure_index][term_index];
  }
  /// In the figure's unit.
  double Of(const FigureRow& row) const {
    return SiOf(row) / figure->unit.scale;
  }
};
/// All of them; the table outlives them.
std::vector<FigureColumn> ColumnsOf(const StudyTable& table);

/// A figure of a row of the table by its name ("max_std_n", component
/// included), in SI; absent if the table has none of that name.
std::optional<double> FigureOf(const StudyTable& table, const FigureRow& row,
                               const std::string& name);

/// Figures that many tables have: how many runs failed, their grades, the mean
/// of kSeconds.
Figure FailedFigure();
Figure GradesFigure();
Figure SecondsFigure();

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_RUN_TABLE_H_
