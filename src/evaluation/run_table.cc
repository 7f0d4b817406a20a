#include "evaluation/run_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "evaluation/statistics.h"

namespace hindsight {
namespace {

template <std::size_t grade>
double CountGrade(const RunCell& cell, const std::string&, const TimeRange&) {
  return cell.grades()[grade];
}

}  // namespace

RunCell::RunCell(std::vector<const RunRecord*> records, const SeriesFold* fold)
    : all_(std::move(records)), fold_(fold) {
  for (const RunRecord* record : all_) {
    if (record->answered) answered_.push_back(record);
  }
  if (fold_ != nullptr) t_ = fold_->t;
  if (answered_.empty() || fold_ != nullptr) return;
  t_ = answered_.front()->t;
  for (const RunRecord* record : answered_) MatchTimes(record->t, &t_);
  for (const RunRecord* record : answered_) {
    std::vector<double> all = t_;
    index_.push_back(MatchTimes(record->t, &all));
  }
}

int RunCell::failed() const {
  return static_cast<int>(
      std::count_if(all_.begin(), all_.end(),
                    [](const RunRecord* record) { return record->failed; }));
}

std::array<int, 3> RunCell::grades() const {
  std::array<int, 3> counts = {};
  for (const RunRecord* record : all_) {
    if (record->grade) ++counts[static_cast<std::size_t>(*record->grade)];
  }
  return counts;
}

std::vector<double> RunCell::Values(const std::string& name) const {
  std::vector<double> out;
  for (const RunRecord* record : answered_) {
    for (const auto& [key, value] : record->values) {
      if (key == name) out.push_back(value);
    }
  }
  return out;
}

std::vector<double> RunCell::Pooled(const std::string& name,
                                    const TimeRange& range) const {
  std::vector<double> out;
  for (const RunRecord* record : answered_) {
    const auto series = record->series.find(name);
    if (series == record->series.end()) continue;
    for (std::size_t k = 0; k < record->t.size(); ++k) {
      if (range.Contains(record->t[k])) out.push_back(series->second[k]);
    }
  }
  return out;
}

std::vector<double> RunCell::Curve(const std::string& name,
                                   Statistic over_runs) const {
  if (fold_ != nullptr) {
    const auto found = fold_->series.find(name);
    if (found == fold_->series.end()) return {};
    if (over_runs == Mean) return found->second.mean;
    if (over_runs == StandardDeviation)
      return SeriesFold::Deviation(found->second);
    throw std::logic_error("folded series know no such statistic");
  }
  std::vector<std::pair<const std::vector<double>*, std::size_t>> series;
  for (std::size_t i = 0; i < answered_.size(); ++i) {
    const auto found = answered_[i]->series.find(name);
    if (found != answered_[i]->series.end()) {
      series.emplace_back(&found->second, i);
    }
  }
  std::vector<double> out;
  if (series.empty()) return out;
  std::vector<double> at(series.size());
  for (std::size_t k = 0; k < t_.size(); ++k) {
    for (std::size_t i = 0; i < series.size(); ++i) {
      at[i] = (*series[i].first)[index_[series[i].second][k]];
    }
    out.push_back(over_runs(at));
  }
  return out;
}

std::vector<double> RunCell::Within(const std::vector<double>& curve,
                                    const TimeRange& range) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    if (range.Contains(t_[k])) out.push_back(curve[k]);
  }
  return out;
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
                       fold == folds.end() ? nullptr : &fold->second);
    FigureRow& row = rows.emplace_back();
    row.labels = *labels;
    row.runs = cell.runs();
    row.failed = cell.failed();
    for (const Figure& figure : table.figures) {
      std::vector<double>& values = row.values.emplace_back();
      if (figure.list != nullptr) values = figure.list(cell);
      for (const Term& term : figure.terms) {
        values.push_back(term.reduce(cell, term.quantity, figure.range));
      }
    }
    row.t = cell.t();
    for (const FigureCurve& curve : table.curves) {
      row.curves.push_back(cell.Curve(curve.quantity, curve.over_runs));
    }
  }
  return rows;
}

std::vector<FigureColumn> ColumnsOf(const StudyTable& table) {
  std::vector<FigureColumn> columns;
  for (std::size_t f = 0; f < table.figures.size(); ++f) {
    const Figure& figure = table.figures[f];
    for (std::size_t i = 0; i < figure.terms.size(); ++i) {
      const std::string& part = figure.terms[i].component;
      columns.push_back(
          {figure.name + (part.empty() ? "" : "_" + part), &figure, f, i});
    }
  }
  return columns;
}

std::optional<double> FigureOf(const StudyTable& table, const FigureRow& row,
                               const std::string& name) {
  for (const FigureColumn& column : ColumnsOf(table)) {
    if (column.name == name) return column.SiOf(row);
  }
  return std::nullopt;
}

StudyTable Under(std::vector<std::string> columns, StudyTable table) {
  std::ranges::move(table.labels, std::back_inserter(columns));
  table.labels = std::move(columns);
  return table;
}

Interval AneesBoundsOf(const RunCell& cell, double confidence) {
  const std::vector<double> states = cell.Values("states");
  if (states.empty()) return {std::nan(""), std::nan("")};
  return AneesBounds(cell.answered(),
                     static_cast<int>(std::lround(states.front())), confidence);
}

double AneesOutside(const RunCell& cell, const std::string& quantity,
                    const TimeRange& range) {
  const Interval bounds = AneesBoundsOf(cell);
  std::vector<double> outside;
  for (const double value : cell.Within(cell.Curve(quantity, Mean), range)) {
    outside.push_back(bounds.Contains(value) ? 0.0 : 1.0);
  }
  return Mean(outside);
}

Figure Several(const std::string& name, Unit unit, const std::string& title,
               const char* format, Terms terms, TimeRange range) {
  return {name, unit, title, format, std::move(terms), range};
}

Figure Single(const std::string& name, Unit unit, const std::string& title,
              const char* format, const std::string& quantity,
              const Reduce& reduce) {
  return Several(name, unit, title, format, {{"", quantity, reduce}});
}

Figure Share(const std::string& name, const std::string& title,
             const std::string& quantity, const Reduce& reduce) {
  Figure figure = Single(name, kPlain, title, "{:.1f}", quantity, reduce);
  figure.factor = 100.0;
  return figure;
}

Figure AneesBoundFigure(const char* title, const char* format,
                        double confidence) {
  const auto bound = [confidence](double Interval::*end) -> Reduce {
    return [=](const RunCell& cell, const std::string&, const TimeRange&) {
      return AneesBoundsOf(cell, confidence).*end;
    };
  };
  return Several("anees_bound", kPlain, title, format,
                 {{"lower", "", bound(&Interval::lower)},
                  {"upper", "", bound(&Interval::upper)}});
}

Figure FailedFigure() {
  Figure figure = Single("failed", kPlain, "failed", "{:.0f}", "",
                         [](const RunCell& cell, const std::string&,
                            const TimeRange&) { return 1.0 * cell.failed(); });
  figure.hide_zero = true;
  return figure;
}

Figure GradesFigure() {
  return Several("grades", kPlain, "usable,\ndoubtful,\nnot", "{:.0f}",
                 {{"usable", "", CountGrade<0>},
                  {"doubtful", "", CountGrade<1>},
                  {"not_usable", "", CountGrade<2>}});
}

Figure SecondsFigure() {
  Figure figure = Single("seconds_per_run", kPlain, "s/run", "{:.3f}", kSeconds,
                         OfRuns<Mean>);
  figure.is_repeatable = false;
  return figure;
}

}  // namespace hindsight
