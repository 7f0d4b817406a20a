#include "evaluation/run_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "evaluation/statistics.h"

namespace hindsight {

std::optional<double> RunRecord::Find(const std::string& name) const {
  const auto found =
      std::ranges::find(values, name, &decltype(values)::value_type::first);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

int RunCell::Count(bool RunRecord::*what) const {
  return static_cast<int>(std::ranges::count(
      records_, true, [what](const RunRecord* r) { return r->*what; }));
}

int RunCell::graded(Grade grade) const {
  return static_cast<int>(
      std::ranges::count(records_, std::optional(grade),
                         [](const RunRecord* r) { return r->grade; }));
}

std::vector<double> RunCell::Values(const std::string& name) const {
  std::vector<double> out;
  for (const RunRecord* record : records_) {
    if (!record->answered) continue;
    if (const auto value = record->Find(name)) out.push_back(*value);
  }
  return out;
}

std::vector<double> RunCell::Curve(const std::string& name,
                                   SeriesFold::OverRuns over_runs) const {
  const auto found = series_.series.find(name);
  return found == series_.series.end() ? std::vector<double>()
                                       : over_runs(found->second);
}

Reduce OfRuns(Statistic statistic) {
  return [statistic](const RunCell& cell, const std::string& quantity) {
    return statistic(cell.Values(quantity));
  };
}

namespace {

Reduce Counted(int (RunCell::*count)() const) {
  return [count](const RunCell& cell, const std::string&) {
    return static_cast<double>((cell.*count)());
  };
}

/// The part of a curve that lies in the span.
std::vector<double> Within(const TimeRange& range, const std::vector<double>& t,
                           const std::vector<double>& curve) {
  std::vector<double> out;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    if (range.Contains(t[k])) out.push_back(curve[k]);
  }
  return out;
}

}  // namespace

Reduce OfCurve(Statistic over_time, SeriesFold::OverRuns over_runs,
               const TimeRange& range) {
  return [=](const RunCell& cell, const std::string& quantity) {
    return over_time(Within(range, cell.t(), cell.Curve(quantity, over_runs)));
  };
}

Interval AneesBoundsOf(const RunCell& cell, double confidence) {
  const std::vector<double> states = cell.Values("states");
  if (states.empty()) return {std::nan(""), std::nan("")};
  return AneesBounds(cell.answered(),
                     static_cast<int>(std::lround(states.front())), confidence);
}

double AneesOutside(const RunCell& cell, const std::string& quantity) {
  const Interval bounds = AneesBoundsOf(cell);
  std::vector<double> outside;
  for (const double value : cell.Curve(quantity, SeriesFold::Mean)) {
    outside.push_back(bounds.Contains(value) ? 0.0 : 1.0);
  }
  return Mean(outside);
}

Measure OfPart(PartErrors StateErrors::*part,
               double (*statistic)(const PartErrors&), const TimeRange& range) {
  return [=](const StateErrors& errors) -> std::optional<double> {
    if ((errors.*part).e.empty()) return std::nullopt;
    return statistic(errors.Within(part, range));
  };
}

Figure Measured(const std::string& name, const Unit& unit, Statistic over_runs,
                const Measure& measure) {
  return {name, unit, OfRuns(over_runs), "", true, measure};
}

void StudyTable::Record(const StateErrors& errors, RunRecord* record) const {
  for (const Figure& figure : figures) {
    if (!figure.measure) continue;
    const std::optional<double> value = figure.measure(errors);
    if (value) record->values.emplace_back(figure.name, *value);
  }
  record->t = errors.t;
  for (const auto& [name, of] : series) {
    record->series[name] = of(errors);
    if (record->series[name].empty()) record->series.erase(name);
  }
}

void StudyTable::Add(std::vector<Figure> more) {
  std::ranges::move(more, std::back_inserter(figures));
}

void StudyTable::AddAxes(const Figure& figure) {
  for (const char* axis : {"_n", "_e", "_d"}) {
    Figure& one = figures.emplace_back(figure);
    one.name += axis;
    one.quantity += axis;
  }
}

void StudyTable::AddAneesBounds(double confidence) {
  const auto bound = [&](double Interval::*end) -> Reduce {
    return [=](const RunCell& cell, const std::string&) {
      return AneesBoundsOf(cell, confidence).*end;
    };
  };
  Add({{"anees_bound_lower", kPlain, bound(&Interval::lower)},
       {"anees_bound_upper", kPlain, bound(&Interval::upper)}});
}

void StudyTable::AddGrades() {
  const auto count = [](Grade grade) -> Reduce {
    return [grade](const RunCell& cell, const std::string&) {
      return static_cast<double>(cell.graded(grade));
    };
  };
  Add({{"grades_usable", kPlain, count(Grade::kUsable)},
       {"grades_doubtful", kPlain, count(Grade::kDoubtful)},
       {"grades_not_usable", kPlain, count(Grade::kUnusable)}});
}

Figure FailedFigure() { return {"failed", kPlain, Counted(&RunCell::failed)}; }

Figure SecondsFigure() {
  return {"seconds_per_run", kPlain, OfRuns(Mean), kSeconds, false};
}

std::vector<FigureRow> Summarize(const StudyTable& table, std::size_t index,
                                 std::span<const RunRecord> records,
                                 const CellFolds& folds) {
  std::vector<const std::vector<std::string>*> order;
  std::map<std::vector<std::string>, std::vector<const RunRecord*>> cells;
  for (const RunRecord& record : records) {
    if (record.table != index) continue;
    std::vector<const RunRecord*>& cell = cells[record.labels];
    if (cell.empty()) order.push_back(&record.labels);
    cell.push_back(&record);
  }
  std::vector<FigureRow> rows;
  for (const std::vector<std::string>* labels : order) {
    const auto fold = folds.find({index, *labels});
    const RunCell cell(cells[*labels],
                       fold == folds.end() ? SeriesFold() : fold->second);
    FigureRow& row =
        rows.emplace_back(FigureRow{*labels, cell.runs(), {}, cell.t(), {}});
    for (const Figure& figure : table.figures) {
      row.values.push_back(figure.reduce(
          cell, figure.quantity.empty() ? figure.name : figure.quantity));
    }
    for (const FigureCurve& curve : table.curves) {
      row.curves.push_back(cell.Curve(curve.quantity, curve.over_runs));
    }
  }
  return rows;
}

StudyTable Under(std::vector<std::string> columns, StudyTable table) {
  std::ranges::move(table.labels, std::back_inserter(columns));
  table.labels = std::move(columns);
  return table;
}

std::optional<double> FigureOf(const StudyTable& table, const FigureRow& row,
                               const std::string& name) {
  const auto found = std::ranges::find(table.figures, name, &Figure::name);
  if (found == table.figures.end()) return std::nullopt;
  return row.values[static_cast<std::size_t>(found - table.figures.begin())];
}

}  // namespace hindsight
