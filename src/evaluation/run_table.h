#ifndef HINDSIGHT_EVALUATION_RUN_TABLE_H_
#define HINDSIGHT_EVALUATION_RUN_TABLE_H_

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
#include "evaluation/state_errors.h"
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
  /// By name, a value at every t. They are folded as the runs come in, and gone
  /// from the record then.
  std::map<std::string, std::vector<double>> series;

  /// Makes it a failed run without an answer; `what` was wrong with the data.
  void Fail(std::string what = "") {
    failed = true;
    answered = false;
    refusal = std::move(what);
  }
  /// Absent of what the method does not tell.
  std::optional<double> Find(const std::string& name) const;
};

/// All runs of one case and method. What is asked for and was never recorded is
/// empty. Runs that were not answered take part in counts alone.
class RunCell {
 public:
  /// `series` are those of the answered records, which outlive the cell.
  explicit RunCell(std::vector<const RunRecord*> records,
                   SeriesFold series = {})
      : records_(std::move(records)), series_(std::move(series)) {}

  int runs() const { return static_cast<int>(records_.size()); }
  int answered() const { return Count(&RunRecord::answered); }
  int failed() const { return Count(&RunRecord::failed); }
  int graded(Grade grade) const;

  /// Of every run that has the value, in order of seeds.
  std::vector<double> Values(const std::string& name) const;
  /// Times at which every run has its series.
  const std::vector<double>& t() const { return series_.t; }
  /// A statistic over the runs at every t().
  std::vector<double> Curve(const std::string& name,
                            SeriesFold::OverRuns over_runs) const;

 private:
  int Count(bool RunRecord::*what) const;

  std::vector<const RunRecord*> records_;
  SeriesFold series_;
};

/// A unit as printed, and what it is in SI.
struct Unit {
  const char* name = "1";
  double scale = 1.0;
};
inline constexpr Unit kPlain = {};
inline constexpr Unit kMetres = {"m", 1.0};
inline constexpr Unit kDegrees = {"deg", kDegree};

/// One number of a cell, of the values or series of that name; NaN if there is
/// none.
using Reduce =
    std::function<double(const RunCell& cell, const std::string& quantity)>;
using Statistic = double (*)(const std::vector<double>&);

/// Over the values of the runs.
Reduce OfRuns(Statistic statistic);
/// Over a span of time of what a series is over the runs at each.
Reduce OfCurve(Statistic over_time, SeriesFold::OverRuns over_runs,
               const TimeRange& range = {});

/// A value of one run; absent where its errors do not tell it.
using Measure = std::function<std::optional<double>(const StateErrors& errors)>;
/// Of the part, which may be empty, within the range.
Measure OfPart(PartErrors StateErrors::*part,
               double (*statistic)(const PartErrors&),
               const TimeRange& range = {});

/// One figure of a table.
struct Figure {
  std::string name;  ///< "max_std_n"
  Unit unit;
  Reduce reduce;
  std::string quantity = {};  ///< "": that of its own name
  bool is_repeatable = true;  ///< false: not the same in an equal call
  Measure measure = nullptr;  ///< of a run, as the value that is reduced
};
/// Of a value that is measured.
Figure Measured(const std::string& name, const Unit& unit, Statistic over_runs,
                const Measure& measure);

/// Two-sided bounds of the average over the answered runs of a normalised squared
/// error with as many degrees of freedom as their value `states`; NaN without.
Interval AneesBoundsOf(const RunCell& cell, double confidence = 0.95);
/// Share of the times at which that average of the quantity is outside of them.
double AneesOutside(const RunCell& cell, const std::string& quantity);

/// A figure against time.
struct FigureCurve {
  std::string name;
  Unit unit;
  std::string quantity;
  SeriesFold::OverRuns over_runs;
};

/// What is known of one kind of record: its label columns, its figures.
struct StudyTable {
  std::string name;                 ///< "cells"
  std::vector<std::string> labels;  ///< columns, the method last
  std::vector<Figure> figures = {};
  std::vector<FigureCurve> curves = {};
  /// Series of a run, at the times of its errors.
  std::vector<std::pair<std::string, std::function<std::vector<double>(
                                         const StateErrors& errors)>>>
      series = {};

  /// Adds what its figures measure and its series are.
  void Record(const StateErrors& errors, RunRecord* record) const;
  void Add(std::vector<Figure> more);
  /// Of the series NAME_n, _e and _d, a figure each.
  void AddAxes(const Figure& figure);
  /// anees_bound_lower and _upper, AneesBoundsOf.
  void AddAneesBounds(double confidence = 0.95);
  /// How many runs have each grade: grades_usable, _doubtful, _not_usable.
  void AddGrades();
};
/// How many runs failed; the mean of kSeconds.
Figure FailedFigure();
Figure SecondsFigure();

/// A row of figures.
struct FigureRow {
  std::vector<std::string> labels;
  int runs = 0;
  std::vector<double> values;  ///< by figure of the table, SI; NaN: none
  std::vector<double> t;
  std::vector<std::vector<double>> curves;  ///< by curve of the table, SI
};

/// The figures of the records that belong to the table of that index, a row a
/// cell in the order of their first appearance; their series are in `folds`.
std::vector<FigureRow> Summarize(const StudyTable& table, std::size_t index,
                                 std::span<const RunRecord> records,
                                 const CellFolds& folds = {});

/// The table with these label columns before its own.
StudyTable Under(std::vector<std::string> columns, StudyTable table);

/// A figure of a row of the table by its name, in SI; absent if the table has
/// none of that name.
std::optional<double> FigureOf(const StudyTable& table, const FigureRow& row,
                               const std::string& name);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_RUN_TABLE_H_
