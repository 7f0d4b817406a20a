#include "app/report_html.h"
#include "app/report_lines.h"
#include "base/text.h"
#include "base/units.h"
#include "io/paths.h"

namespace hindsight {
namespace {

/// Columns of METHOD.constants.csv: value, and value plus and minus sigma, by
/// "NAME [UNIT]"; angles in degrees.
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
    std::vector<double> value = values;
    std::vector<double> upper = values;
    std::vector<double> lower = values;
    for (std::size_t k = 0; k < value.size(); ++k) {
      const double unit = angle ? kDegree : 1.0;
      value[k] = values[k] / unit;
      upper[k] = (values[k] + sigma->second[k]) / unit;
      lower[k] = (values[k] - sigma->second[k]) / unit;
    }
    series.columns[name] = std::move(value);
    series.columns["+" + name] = std::move(upper);
    series.columns["-" + name] = std::move(lower);
  }
  return series;
}

/// Every constant of the first forward method that has some.
std::string ConstantFigures(ReportContext* context) {
  for (std::size_t i = 0; i < context->solutions.size(); ++i) {
    const ReportSolution& solution = context->solutions[i];
    const auto path = context->sources[solution.source].folder /
                      (solution.method + ".constants.csv");
    if (!PathExists(path)) continue;
    ReportSeries series = ConstantSeries(ReadNumberColumns(path.string()));
    std::vector<std::string> names;
    for (const auto& [name, values] : series.columns) {
      if (name[0] != '+' && name[0] != '-') names.push_back(name);
    }
    const int table = context->data.Add(std::move(series));
    std::string figures;
    for (const std::string& name : names) {
      const std::size_t bracket = name.rfind(" [");
      Chart chart = {
          .title = name.substr(0, bracket),
          .unit = name.substr(bracket + 2, name.size() - bracket - 3)};
      const int number = static_cast<int>(i);
      for (const char* sign : {"+", "-"}) {
        chart.lines.push_back(
            {.table = table,
             .column = sign + name,
             .label = sign == std::string("+") ? "plus and minus sigma" : "",
             .group = number,
             .colour = -1,
             .style = "dash"});
      }
      chart.lines.push_back({.table = table,
                             .column = name,
                             .label = solution.label,
                             .group = number,
                             .colour = number});
      figures += context->data.Figure(std::move(chart));
    }
    return figures;
  }
  return "";
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
    add(Format("bg_%c", axis), Format("Gyro bias %c", axis), "deg/h");
  }
  for (const char axis : {'x', 'y', 'z'}) {
    add(Format("ba_%c", axis), Format("Accelerometer bias %c", axis), "m/s^2");
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
              ? Absent("No constants over time: none is estimated, or no "
                       "forward method (ekf) ran.")
              : "<h3>Constants as time went on</h3>\n" + Grid(constants, ""));
}

}  // namespace hindsight
