#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "app/report_html.h"
#include "app/report_lines.h"
#include "base/units.h"

namespace hindsight {
namespace {

/// Columns of METHOD.constants.csv: value by "NAME [UNIT]", sigma by "sd_NAME
/// [UNIT]"; angles in degrees.
ReportSeries ConstantSeries(NumberColumns columns) {
  ReportSeries series;
  series.t = std::move(columns["t[s]"]);
  for (const auto& [title, values] : columns) {
    const auto sigma = columns.find("sd_" + title);
    if (sigma == columns.end()) continue;
    const std::size_t bracket = title.rfind('[');
    const bool angle = title.compare(bracket, 4, "[rad") == 0;
    const std::string name =
        title.substr(0, bracket) + " " +
        (angle ? "[deg" + title.substr(bracket + 4) : title.substr(bracket));
    const double unit = angle ? kDegree : 1.0;
    std::vector<double>& shown = series.columns[name];
    std::vector<double>& shown_sigma = series.columns["sd_" + name];
    for (std::size_t k = 0; k < values.size(); ++k) {
      shown.push_back(values[k] / unit);
      shown_sigma.push_back(sigma->second[k] / unit);
    }
  }
  return series;
}

/// The lines of one constant of one solution, in its colour.
void AddConstantLines(const ReportSolution& solution, int number, int table,
                      const std::string& name, Chart* chart) {
  const std::string sigma = "sd_" + name;
  // A backward filter begins with nothing.
  const std::string spread = solution.forward ? "" : sigma;
  for (const double factor : {1.0, -1.0}) {
    chart->lines.push_back({.table = table,
                            .column = sigma,
                            .group = number,
                            .colour = number,
                            .factor = factor,
                            .centre = name,
                            .style = "dash",
                            .spread = spread});
  }
  chart->lines.push_back(
      {.table = table,
       .column = name,
       .label = solution.label + (solution.forward ? "" : ", backward"),
       .group = number,
       .colour = number,
       .spread = spread});
}

/// Every constant, of all solutions that tell it over time.
std::string ConstantFigures(ReportContext* context) {
  std::vector<std::pair<std::string, Chart>> charts;
  for (std::size_t i = 0; i < context->solutions.size(); ++i) {
    const ReportSolution& solution = context->solutions[i];
    const auto path = context->sources[solution.source].FileOf(
        solution.method + ".constants.csv");
    if (!path) continue;
    ReportSeries series = ConstantSeries(ReadNumberColumns(path->string()));
    std::vector<std::string> names;
    for (const auto& [name, values] : series.columns) {
      if (!name.starts_with("sd_")) names.push_back(name);
    }
    const int table = context->data.Add(std::move(series));
    for (const std::string& name : names) {
      auto chart =
          std::find_if(charts.begin(), charts.end(),
                       [&name](const auto& one) { return one.first == name; });
      if (chart == charts.end()) {
        const std::size_t bracket = name.rfind(" [");
        charts.push_back(
            {name,
             {.title = name.substr(0, bracket),
              .unit = name.substr(bracket + 2, name.size() - bracket - 3)}});
        chart = charts.end() - 1;
      }
      AddConstantLines(solution, static_cast<int>(i), table, name,
                       &chart->second);
    }
  }
  std::string figures;
  for (auto& [name, chart] : charts) {
    figures += context->data.Figure(std::move(chart));
  }
  return figures;
}

}  // namespace

std::string BiasPanel(ReportContext* context) {
  std::string figures;
  const auto add = [&](const std::string& column, const std::string& title,
                       const std::string& unit) {
    std::vector<ChartLine> lines = LinesOf(*context, column);
    const int best = context->best().table;
    if (!context->data.Has(best, column)) return;
    for (const double factor : {1.0, -1.0}) {
      lines.push_back({.table = best,
                       .column = "sd_" + column,
                       .label = factor > 0.0 ? "plus and minus sigma" : "",
                       .colour = -1,
                       .factor = factor,
                       .centre = column,
                       .style = "dash"});
    }
    figures += context->data.Figure(
        {.title = title, .unit = unit, .lines = std::move(lines)});
  };
  for (const char axis : {'x', 'y', 'z'}) {
    add(fmt::format("bg_{}", axis), fmt::format("Gyro bias {}", axis), "deg/h");
  }
  for (const char axis : {'x', 'y', 'z'}) {
    add(fmt::format("ba_{}", axis), fmt::format("Accelerometer bias {}", axis),
        "m/s^2");
  }
  const std::string constants = ConstantFigures(context);
  std::string text =
      figures.empty()
          ? ""
          : Element("p",
                    "Measured minus true, body axes. Dashed: the recommended "
                    "solution plus and minus one sigma.");
  return text + Grid(figures, "No bias is estimated.") +
         (constants.empty()
              ? Absent("No constants over time: none is estimated, or neither "
                       "a forward method (ekf) nor two_filter ran.")
              : "<h3>Constants over time</h3>\n" +
                    Element("p",
                            "Forward methods as they learned them from what "
                            "came before, backward filters from what came "
                            "later. Dashed: plus and minus one sigma.") +
                    Grid(constants, ""));
}

}  // namespace hindsight
