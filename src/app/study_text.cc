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

std::string Cell(double value) {
  if (std::isnan(value)) return "";
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "never";
}

/// "max\nstd n\n[m]" of max_std_n: a line a word or two.
std::string HeadingOf(const Figure& figure) {
  constexpr std::size_t kWidth = 9;
  std::string text;
  std::size_t width = 0;
  for (const std::string& word : Split(figure.name, '_')) {
    const bool fits = width + 1 + word.size() <= kWidth;
    if (!text.empty()) text += fits ? ' ' : '\n';
    width = word.size() + (fits ? width + 1 : 0);
    text += word;
  }
  const std::string unit = figure.unit.name;
  return unit == "1" ? text : text + "\n[" + unit + "]";
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

}  // namespace

StudyGrid GridOf(const StudyTable& table, const std::vector<FigureRow>& rows) {
  const bool has_method = table.labels.size() > 1;
  const std::vector<std::string> of_case(table.labels.begin(),
                                         table.labels.end() - has_method);
  StudyGrid grid;
  grid.heading = {Joined(of_case, ", "), has_method ? table.labels.back() : ""};
  for (const Figure& figure : table.figures) {
    grid.heading.push_back(HeadingOf(figure));
  }
  const FigureRow* before = nullptr;
  for (const FigureRow& row : rows) {
    std::vector<std::string>& cells =
        grid.rows.emplace_back(LabelCells(row, before));
    before = &row;
    for (std::size_t f = 0; f < table.figures.size(); ++f) {
      cells.push_back(Cell(row.values[f] / table.figures[f].unit.scale));
    }
  }
  return grid;
}

std::string StudyText(const StudyResult& result) {
  constexpr std::size_t kWidth = 160;
  TableStyle style = StyleOfOutput();
  if (style.width == 0) style.width = kWidth;
  std::string text;
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    const std::vector<FigureRow>& rows = result.rows[i];
    if (rows.empty() || (i > 0 && rows.size() > kMostRows)) continue;
    const StudyGrid grid = GridOf(result.tables[i], rows);
    ReportTable table(grid.heading, 2);
    for (const std::vector<std::string>& cells : grid.rows) table.AddRow(cells);
    text += "\n" + table.Render(style);
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
