#include <fmt/core.h>

#include <cmath>

#include "app/flags.h"
#include "app/study_report.h"
#include "app/terminal.h"
#include "io/write/table.h"

namespace hindsight {
namespace {

/// Of a table beside the first that a terminal shows.
constexpr std::size_t kMostRows = 100;

/// The components of a figure, "0.012  0.034".
std::string Cell(const Figure& figure, const std::vector<double>& values) {
  std::string text;
  for (const double one_value : values) {
    const double value = figure.factor * one_value / figure.unit.scale;
    if (std::isnan(value) || (figure.hide_zero && value == 0.0)) continue;
    text += text.empty() ? "" : " ";
    text += std::isfinite(value)
                ? fmt::format(fmt::runtime(figure.format), value)
                : "never";
  }
  return text;
}

/// Case and method in two columns; a case that goes on is not named again.
std::vector<std::string> LabelCells(const FigureRow& row,
                                    const FigureRow* before) {
  const auto case_of = [](const FigureRow& one) {
    return Joined({one.labels.begin(), one.labels.end() - 1}, ", ");
  };
  const std::string name = case_of(row);
  if (row.labels.size() == 1) return {row.labels[0], ""};
  const bool goes_on = before != nullptr && case_of(*before) == name;
  return {goes_on ? "" : name, row.labels.back()};
}

std::string TableText(const StudyTable& table,
                      const std::vector<FigureRow>& rows, int part) {
  const StudyGrid grid = GridOf(table, rows, part);
  if (grid.rows.empty()) return "";
  ReportTable text(grid.heading, 2);
  for (const std::vector<std::string>& cells : grid.rows) text.AddRow(cells);
  return text.Render(StyleOfOutput());
}

}  // namespace

StudyGrid GridOf(const StudyTable& table, const std::vector<FigureRow>& rows,
                 int part) {
  const bool has_method = table.labels.size() > 1;
  const std::vector<std::string> of_case(table.labels.begin(),
                                         table.labels.end() - has_method);
  StudyGrid grid;
  grid.heading = {Joined(of_case, ", "), has_method ? table.labels.back() : ""};
  std::vector<std::size_t> shown;
  for (std::size_t f = 0; f < table.figures.size(); ++f) {
    const Figure& figure = table.figures[f];
    if (figure.title.empty() || figure.part != part) continue;
    shown.push_back(f);
    grid.heading.push_back(figure.title);
  }
  bool is_empty = true;
  const FigureRow* before = nullptr;
  for (const FigureRow& row : rows) {
    std::vector<std::string> cells = LabelCells(row, before);
    before = &row;
    for (const std::size_t f : shown) {
      cells.push_back(Cell(table.figures[f], row.values[f]));
      is_empty = is_empty && cells.back().empty();
    }
    grid.rows.push_back(std::move(cells));
  }
  if (is_empty) grid.rows.clear();
  return grid;
}

std::string StudyText(const StudyResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    if (i > 0 && result.rows[i].size() > kMostRows) continue;
    for (const int part : {0, 1}) {
      const std::string one = TableText(result.tables[i], result.rows[i], part);
      if (!one.empty()) text += "\n" + one;
    }
  }
  constexpr std::size_t kMostRefusals = 10;
  if (!result.refusals.empty()) text += "\nrefused data, counted as failed:\n";
  for (std::size_t i = 0; i < result.refusals.size(); ++i) {
    if (i == kMostRefusals) {
      text += fmt::format("  and {} more\n", result.refusals.size() - i);
      break;
    }
    text += "  " + result.refusals[i] + "\n";
  }
  return text;
}

}  // namespace hindsight
