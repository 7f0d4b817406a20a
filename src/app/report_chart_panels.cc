#include <fmt/core.h>

#include "app/report_html.h"
#include "app/report_lines.h"
#include "io/read/result_columns.h"
#include "io/write/html.h"

namespace hindsight {

std::string AccuracyPanel(ReportContext* context) {
  constexpr ShownQuantity kQuantities[] = {
      {"sd_h", "Horizontal position", "m"},
      {"sd_d", "Height", "m"},
      {"sd_v_h", "Horizontal velocity", "m/s"},
      {"sd_v_d", "Vertical velocity", "m/s"},
      {"sd_tilt", "Tilt (roll and pitch)", "deg"},
      {"sd_heading", "Heading", "deg"},
  };
  std::string figures;
  for (const ShownQuantity& q : kQuantities) {
    figures += context->data.Figure({.title = q.title,
                                     .unit = q.unit,
                                     .lines = LinesOf(*context, q.column),
                                     .logarithmic = true});
  }
  return Element("p",
                 "One standard deviation, as each method states it; horizontal "
                 "is the root of the sum of both squares. The scale is "
                 "logarithmic where values span more than a factor of 20.") +
         Grid(figures, "The solutions hold no standard deviations.");
}

namespace {

/// Body rates and specific force of the recommended solution.
std::string BodyFigures(ReportContext* context) {
  const ReportSolution& best = context->best();
  const auto path = context->reference().ColumnsOf(best.method + ".motion");
  if (!path) return "";
  NumberColumns columns = ReadNumberColumns(path->string());
  ReportSeries series;
  series.t = std::move(columns["t[s]"]);
  columns.erase("t[s]");
  series.columns = std::move(columns);
  const int table = context->data.Add(std::move(series));
  struct Vector {
    const char* title;
    const char* stem;
    const char* unit;
  };
  std::string figures;
  for (const Vector& v : {Vector{"Body rate", "w", "deg/s"},
                          Vector{"Specific force", "f", "m/s^2"}}) {
    Chart chart = {.title = v.title,
                   .unit = v.unit,
                   .note =
                       "Body axes forward, right, down; biases removed, "
                       "means between the epochs."};
    const char* const axes[] = {"x", "y", "z"};
    const char* const names[] = {"forward", "right", "down"};
    for (int axis = 0; axis < 3; ++axis) {
      chart.lines.push_back(
          {.table = table,
           .column = fmt::format("{}_{}[{}]", v.stem, axes[axis], v.unit),
           .label = names[axis],
           .colour = axis});
    }
    figures += context->data.Figure(std::move(chart));
  }
  return figures;
}

}  // namespace

std::string MotionPanel(ReportContext* context) {
  constexpr ShownQuantity kQuantities[] = {
      {"height", "Height above the ellipsoid", "m"},
      {"speed", "Horizontal speed", "m/s"},
      {"v_d", "Velocity down", "m/s"},
      {"roll", "Roll", "deg"},
      {"pitch", "Pitch", "deg"},
      {"heading", "Heading", "deg"},
  };
  std::string figures;
  for (const ShownQuantity& q : kQuantities) {
    figures += context->data.Figure({.title = q.title,
                                     .unit = q.unit,
                                     .lines = LinesOf(*context, q.column)});
  }
  return Grid(figures + BodyFigures(context), "The solutions hold no motion.");
}

std::string DifferencePanel(ReportContext* context) {
  if (context->solutions.size() < 2) {
    return Absent("There is one solution only.");
  }
  constexpr ShownQuantity kQuantities[] = {
      {"north", "North", "m"},         {"east", "East", "m"},
      {"height", "Height", "m"},       {"v_n", "Velocity north", "m/s"},
      {"v_e", "Velocity east", "m/s"}, {"v_d", "Velocity down", "m/s"},
      {"roll", "Roll", "deg"},         {"pitch", "Pitch", "deg"},
      {"heading", "Heading", "deg"},
  };
  std::string figures;
  for (const ShownQuantity& q : kQuantities) {
    std::vector<ChartLine> lines = LinesOf(*context, q.column);
    for (ChartLine& line : lines) {
      line.table =
          context->solutions[static_cast<std::size_t>(line.group)].samples;
    }
    figures += context->data.Figure(
        {.title = q.title, .unit = q.unit, .lines = lines, .difference = true});
  }
  return "<p>Each solution minus <span id=\"base\">" +
         EscapeHtml(context->best().label) +
         "</span>. Dashed, in the colour of the solution: the standard "
         "deviation that the difference may have, sqrt|P - P of the other|, "
         "of two smoothers the other's own sigma. Taken at up to 800 "
         "epochs that both have.</p>\n" +
         Grid(figures, "The solutions have no quantity in common.");
}

std::string TruthPanel(ReportContext* context) {
  constexpr ShownQuantity kErrors[] = {
      {"n[m]", "Error north", "m"},
      {"e[m]", "Error east", "m"},
      {"d[m]", "Error down", "m"},
      {"v_n[m/s]", "Velocity error north", "m/s"},
      {"v_e[m/s]", "Velocity error east", "m/s"},
      {"v_d[m/s]", "Velocity error down", "m/s"},
      {"roll[deg]", "Roll error", "deg"},
      {"pitch[deg]", "Pitch error", "deg"},
      {"heading[deg]", "Heading error", "deg"},
      {"nees_position[1]", "Normalised squared position error", "1"},
      {"nees_velocity[1]", "Normalised squared velocity error", "1"},
      {"nees_attitude[1]", "Normalised squared attitude error", "1"},
  };
  std::vector<int> tables;
  for (const ReportSolution& solution : context->solutions) {
    const auto t = solution.errors.find("t[s]");
    if (t == solution.errors.end()) {
      tables.push_back(-1);
      continue;
    }
    ReportSeries series = {t->second, solution.errors,
                           DetailOf(solution, tables.size())};
    series.columns.erase("t[s]");
    if (!tables.empty()) EraseWhatOnlyTheFirstShows(&series.columns);
    tables.push_back(context->data.Add(std::move(series)));
  }
  std::string figures;
  for (const ShownQuantity& q : kErrors) {
    std::vector<ChartLine> lines = LinesOf(*context, q.column);
    for (ChartLine& line : lines) {
      line.table = tables[static_cast<std::size_t>(line.group)];
    }
    for (const double factor : {3.0, -3.0}) {
      lines.push_back({.table = tables.front(),
                       .column = std::string("sd_") + q.column,
                       .label = factor > 0.0 ? "3 sigma" : "-3 sigma",
                       .colour = -1,
                       .factor = factor,
                       .style = "dash"});
    }
    const bool nees = std::string(q.column).starts_with("nees");
    const std::vector<double> bounds =
        nees ? std::vector<double>{7.81, 16.27} : std::vector<double>{};
    figures += context->data.Figure(
        {.title = q.title,
         .unit = q.unit,
         .note = nees ? "Expected 3 on average; passed by chance in 5 % and "
                        "0.1 % of the epochs: the dashed lines."
                      : "",
         .lines = std::move(lines),
         .levels = bounds,
         .logarithmic = nees});
  }
  if (figures.empty()) {
    return Absent(
        "There is no truth to compare with, or the run wrote no "
        "METHOD.errors.csv.");
  }
  return Element("p",
                 "Truth minus solution. Dashed: three sigma of the "
                 "recommended solution. The grades know nothing of it.") +
         Grid(figures, "");
}

}  // namespace hindsight
