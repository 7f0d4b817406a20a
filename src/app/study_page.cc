#include <algorithm>
#include <map>
#include <set>

#include "app/flags.h"
#include "app/line_picture.h"
#include "app/report_html.h"
#include "app/report_page.h"
#include "app/study_report.h"
#include "io/read/units.h"
#include "io/write/html.h"

namespace hindsight {
namespace {

using Labels = std::vector<std::string>;

/// Cases beyond these have their figures in the tables alone.
constexpr std::size_t kMostCases = 12;

/// A case and its rows.
using CaseRows = std::pair<Labels, std::vector<const FigureRow*>>;

std::vector<CaseRows> ByCase(const std::vector<FigureRow>& rows) {
  std::vector<CaseRows> cases;
  for (const FigureRow& row : rows) {
    const Labels labels = {row.labels.begin(), row.labels.end() - 1};
    auto found = std::ranges::find(cases, labels, &CaseRows::first);
    if (found == cases.end()) found = cases.insert(found, {labels, {}});
    found->second.push_back(&row);
  }
  return cases;
}

std::string CurvePicture(const StudyTable& table, std::size_t curve,
                         const std::vector<const FigureRow*>& rows) {
  const FigureCurve& of = table.curves[curve];
  LinePicture picture = {.title = of.name + " [" + of.unit.name + "]",
                         .axis = "t [s]",
                         .lines = {},
                         .logarithmic = true};
  for (const FigureRow* row : rows) {
    std::vector<double> values = row->curves[curve];
    for (double& value : values) value /= of.unit.scale;
    picture.lines.push_back(
        {row->labels.back(),
         {row->t.begin(), row->t.begin() + std::ssize(values)},
         std::move(values)});
    if (of.name != "anees") continue;
    for (const char* bound : {"anees_bound_lower", "anees_bound_upper"}) {
      if (const auto level = FigureOf(table, *row, bound)) {
        picture.levels.push_back(*level);
      }
    }
  }
  return Render(picture);
}

std::string TimePanel(const StudyTable& table,
                      const std::vector<FigureRow>& rows) {
  if (table.curves.empty()) return "";
  std::string html = "<section><h2>Scatter and consistency by time</h2>\n";
  std::size_t count = 0;
  for (const auto& [labels, of_case] : ByCase(rows)) {
    if (++count > kMostCases) {
      html += "<p>The cases after these are in curves.csv.</p>\n";
      break;
    }
    html += Element("h3", Joined(labels, ", ")) + "<div class=\"pictures\">";
    for (std::size_t i = 0; i < table.curves.size(); ++i) {
      html += CurvePicture(table, i, of_case);
    }
    html += "</div>\n";
  }
  return html + "</section>\n";
}

/// The number that a label begins with.
std::optional<double> NumberIn(const std::string& label) {
  return ParseNumber(label.substr(0, label.find(' ')));
}

/// Whether every row has a number in that column, and not all the same.
bool IsSwept(const std::vector<FigureRow>& rows, std::size_t column) {
  std::set<double> values;
  for (const FigureRow& row : rows) {
    const auto value = NumberIn(row.labels[column]);
    if (!value) return false;
    values.insert(*value);
  }
  return values.size() > 1;
}

std::string SweepPicture(const StudyTable& table,
                         const std::vector<FigureRow>& rows, std::size_t column,
                         std::size_t figure) {
  const std::string& first = rows.front().labels[column];
  const std::size_t blank = first.find(' ');
  const std::string& name = table.figures[figure].name;
  const Unit& unit = table.figures[figure].unit;
  LinePicture picture = {
      .title = name + " [" + unit.name + "]",
      .axis = table.labels[column] +
              (blank == first.npos ? "" : " [" + first.substr(blank + 1) + "]"),
      .lines = {},
      .logarithmic = true};
  std::map<Labels, std::map<double, double>> lines;
  for (const FigureRow& row : rows) {
    Labels others = row.labels;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(column));
    lines[others][*NumberIn(row.labels[column])] =
        row.values[figure] / unit.scale;
  }
  for (const auto& [others, points] : lines) {
    LinePicture::Line line = {Joined(others, ", "), {}, {}};
    for (const auto& [x, y] : points) {
      line.x.push_back(x);
      line.y.push_back(y);
    }
    picture.lines.push_back(std::move(line));
  }
  return Render(picture);
}

std::string SweepPanel(const StudyTable& table,
                       const std::vector<FigureRow>& rows) {
  static const std::set<std::string> kShown = {
      "position_rms", "end_horizontal", "heading_rms", "attitude_rms", "anees",
      "nis",          "horizontal_p50"};
  std::string html;
  for (std::size_t column = 0; column + 1 < table.labels.size(); ++column) {
    if (rows.empty() || !IsSwept(rows, column)) continue;
    html += Element("h3", table.labels[column]) + "<div class=\"pictures\">";
    for (std::size_t f = 0; f < table.figures.size(); ++f) {
      if (!kShown.contains(table.figures[f].name)) continue;
      html += SweepPicture(table, rows, column, f);
    }
    html += "</div>\n";
  }
  if (html.empty()) return "";
  return "<section><h2>Sweep</h2>\n" + html + "</section>\n";
}

std::string TablePanel(const StudyTable& table,
                       const std::vector<FigureRow>& rows) {
  if (rows.empty()) return "";
  StudyGrid grid = GridOf(table, rows);
  for (std::string& title : grid.heading)
    std::ranges::replace(title, '\n', ' ');
  HtmlTable out(grid.heading);
  // A browser gives every row its case.
  std::string of_case;
  for (std::vector<std::string>& cells : grid.rows) {
    if (cells.front().empty()) cells.front() = of_case;
    of_case = cells.front();
    out.AddRow(cells);
  }
  return "<section>" + Element("h2", table.name) + out.Render() +
         "</section>\n";
}

}  // namespace

std::string StudyPage(const Study& study, const StudyResult& result,
                      const MonteCarloOptions& options) {
  std::string body =
      Element("p", StudyHeading(study, options) +
                       (result.complete ? "." : "; interrupted."));
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    body += TablePanel(result.tables[i], result.rows[i]);
    body += SweepPanel(result.tables[i], result.rows[i]);
  }
  body += TimePanel(result.tables[0], result.rows[0]);
  return StaticPage(study.name, body);
}

}  // namespace hindsight
