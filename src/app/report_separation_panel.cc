#include "app/report_html.h"
#include "app/report_lines.h"
#include "base/text.h"

namespace hindsight {
namespace {

struct Component {
  const char* name;
  const char* column;  ///< of METHOD.csv, behind "separation_"
  const char* unit;
};

constexpr Component kComponents[] = {
    {"North", "n", "m"},
    {"East", "e", "m"},
    {"Down", "d", "m"},
    {"Velocity north", "v_n", "m/s"},
    {"Velocity east", "v_e", "m/s"},
    {"Velocity down", "v_d", "m/s"},
    {"Roll", "roll", "deg"},
    {"Pitch", "pitch", "deg"},
    {"Heading", "heading", "deg"},
};

/// A chart for each component of the first solution that separates them.
std::string ComponentFigures(ReportContext* context) {
  for (std::size_t i = 0; i < context->solutions.size(); ++i) {
    const ReportSolution& solution = context->solutions[i];
    if (solution.source != 0 || !solution.Has("separation_n[m]")) continue;
    ReportSeries series = {.t = solution.t(), .columns = {}};
    for (const auto& [title, values] : solution.columns) {
      if (title.find("separation_") == title.npos) continue;
      series.columns[title.substr(0, title.find('['))] = values;
    }
    const int table = context->data.Add(std::move(series));
    const int group = static_cast<int>(i);
    std::string figures;
    for (const Component& c : kComponents) {
      const std::string column = std::string("separation_") + c.column;
      Chart chart = {.title = c.name, .unit = c.unit};
      for (const double factor : {3.0, -3.0}) {
        chart.lines.push_back({.table = table,
                               .column = "sd_" + column,
                               .label = factor > 0.0 ? "3 sigma" : "-3 sigma",
                               .group = group,
                               .colour = -1,
                               .factor = factor,
                               .style = "dash",
                               .spread = "sd_" + column});
      }
      chart.lines.push_back({.table = table,
                             .column = column,
                             .label = "forward minus backward",
                             .group = group,
                             .colour = 2,
                             .spread = "sd_" + column});
      figures += context->data.Figure(std::move(chart));
    }
    return figures;
  }
  return "";
}

}  // namespace

std::string SeparationPanel(ReportContext* context) {
  const std::string absent =
      "No method ran that separates forward and backward solutions "
      "(--methods=two_filter).";
  std::string figures = context->data.Figure(
      {.title = "Separation of positions",
       .unit = "sigma",
       .note = "The dashed lines are passed by chance in 5 % and 0.3 % of the "
               "epochs.",
       .lines = LinesOf(*context, "separation"),
       .levels = {2.80, 3.76}});
  const std::string components = ComponentFigures(context);
  if (figures.empty() && components.empty()) return Absent(absent);
  return Element("p",
                 "Distance between the position of the forward filter and "
                 "that of the backward filter, over its standard deviation. "
                 "Both know nothing of each other's measurements: where they "
                 "part, one of them is wrong or surer of itself than it may "
                 "be.") +
         Grid(figures, absent) +
         (components.empty()
              ? Absent("By component: none in these results.")
              : "<h3>By component</h3>\n" +
                    Element("p",
                            "Forward filter with the measurements of the "
                            "epoch minus backward filter without them, and "
                            "three times sqrt(P_f + P_b). Left open where the "
                            "backward filter knows nothing.") +
                    Grid(components, ""));
}

}  // namespace hindsight
