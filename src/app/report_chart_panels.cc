#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report_html.h"
#include "app/report_panels.h"
#include "base/text.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "io/paths.h"

namespace hindsight {
namespace {

/// A column of a solution file, and what it is called on the page.
struct Shown {
  const char* title;  ///< in METHOD.csv
  const char* name;   ///< on the page
};

constexpr Shown kShown[] = {
    {"h[m]", "height"},
    {"v_n[m/s]", "v_n"},
    {"v_e[m/s]", "v_e"},
    {"v_d[m/s]", "v_d"},
    {"roll[deg]", "roll"},
    {"pitch[deg]", "pitch"},
    {"heading[deg]", "heading"},
    {"sd_n[m]", "sd_n"},
    {"sd_e[m]", "sd_e"},
    {"sd_d[m]", "sd_d"},
    {"cov_p_ne[m^2]", "cov_ne"},
    {"sd_v_n[m/s]", "sd_v_n"},
    {"sd_v_e[m/s]", "sd_v_e"},
    {"sd_v_d[m/s]", "sd_v_d"},
    {"sd_roll[deg]", "sd_roll"},
    {"sd_pitch[deg]", "sd_pitch"},
    {"sd_heading[deg]", "sd_heading"},
    {"bg_x[deg/h]", "bg_x"},
    {"bg_y[deg/h]", "bg_y"},
    {"bg_z[deg/h]", "bg_z"},
    {"ba_x[m/s^2]", "ba_x"},
    {"ba_y[m/s^2]", "ba_y"},
    {"ba_z[m/s^2]", "ba_z"},
    {"sd_bg_x[deg/h]", "sd_bg_x"},
    {"sd_bg_y[deg/h]", "sd_bg_y"},
    {"sd_bg_z[deg/h]", "sd_bg_z"},
    {"sd_ba_x[m/s^2]", "sd_ba_x"},
    {"sd_ba_y[m/s^2]", "sd_ba_y"},
    {"sd_ba_z[m/s^2]", "sd_ba_z"},
    {"separation[1]", "separation"},
    {"accel_sigma[m/s^2]", "accel_sigma"},
    {"magnetic[1]", "magnetic"},
};

using Columns = std::map<std::string, std::vector<double>>;

/// sqrt(a^2 + b^2), row by row, as `name`, if both are there.
void AddLength(const std::string& a, const std::string& b,
               const std::string& name, Columns* columns) {
  if (!columns->contains(a) || !columns->contains(b)) return;
  const std::vector<double>& x = columns->at(a);
  const std::vector<double>& y = columns->at(b);
  std::vector<double> length(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) length[k] = std::hypot(x[k], y[k]);
  (*columns)[name] = std::move(length);
}

/// Metres north and east of `origin`, in its axes.
void AddPlace(const ReportSolution& solution, const Geodetic& origin,
              Columns* columns) {
  const std::vector<double>& lat = solution.columns.at("lat[deg]");
  const std::vector<double>& lon = solution.columns.at("lon[deg]");
  const std::vector<double>& h = solution.columns.at("h[m]");
  const Eigen::Vector3d p0 = EcefFromGeodetic(origin);
  const Eigen::Matrix3d C_ne =
      NedAxes(origin.latitude, origin.longitude).transpose();
  std::vector<double> north(lat.size());
  std::vector<double> east(lat.size());
  for (std::size_t k = 0; k < lat.size(); ++k) {
    const Eigen::Vector3d d =
        C_ne *
        (EcefFromGeodetic({lat[k] * kDegree, lon[k] * kDegree, h[k]}) - p0);
    north[k] = d.x();
    east[k] = d.y();
  }
  (*columns)["north"] = std::move(north);
  (*columns)["east"] = std::move(east);
}

/// Whether a solution is shown at full rate however long it is.
bool IsShownWhole(const ReportSolution& solution, std::size_t number) {
  constexpr std::size_t kShort = 6000;
  return number == 0 || solution.t().size() <= kShort;
}

/// What is drawn of the recommended solution alone, as ellipses and bands, or
/// of the others at some rows alone.
void EraseWhatOnlyTheFirstShows(Columns* columns) {
  for (const char* name : {"cov_ne", "sd_n", "sd_e", "sd_v_n", "sd_v_e",
                           "sd_roll", "sd_pitch", "v_n", "v_e"}) {
    columns->erase(name);
  }
  std::erase_if(*columns, [](const auto& column) {
    const std::string& name = column.first;
    return name.starts_with("sd_b") ||
           (name.starts_with("sd_") && name.ends_with("]"));
  });
}

/// Rows at equal steps, few enough to be drawn at once.
ReportSeries SomeRows(const ReportSeries& all) {
  constexpr std::size_t kMost = 800;
  const std::size_t step = (all.t.size() + kMost - 1) / kMost;
  const auto thin = [step](const std::vector<double>& values) {
    std::vector<double> some;
    for (std::size_t k = 0; k < values.size(); k += step) {
      some.push_back(values[k]);
    }
    return some;
  };
  ReportSeries some;
  some.t = thin(all.t);
  for (const char* name :
       {"north",  "east",   "height",  "v_n",     "v_e",      "v_d",
        "roll",   "pitch",  "heading", "sd_n",    "sd_e",     "sd_d",
        "sd_v_n", "sd_v_e", "sd_v_d",  "sd_roll", "sd_pitch", "sd_heading",
        "sd_h",   "speed",  "cov_ne"}) {
    const auto column = all.columns.find(name);
    if (column != all.columns.end()) some.columns[name] = thin(column->second);
  }
  return some;
}

/// Lines of all solutions, the recommended one as a broad ground.
std::vector<ChartLine> LinesOf(const ReportContext& context,
                               const std::string& column, double factor = 1.0) {
  std::vector<ChartLine> lines;
  for (std::size_t i = 0; i < context.solutions.size(); ++i) {
    const ReportSolution& solution = context.solutions[i];
    const int number = static_cast<int>(i);
    lines.push_back({.table = solution.table,
                     .column = column,
                     .label = solution.label,
                     .group = number,
                     .colour = number,
                     .factor = factor});
  }
  return lines;
}

std::string Grid(const std::string& figures, const std::string& why_none) {
  if (figures.empty()) return Absent(why_none);
  return "<div class=\"grid\">" + figures + "</div>\n";
}

struct Quantity {
  const char* column;
  const char* title;
  const char* unit;
};

/// The first solution of the reference that one of `methods` made.
const ReportSolution* FindSolution(const ReportContext& context,
                                   const std::vector<std::string>& methods) {
  for (const std::string& method : methods) {
    for (const ReportSolution& solution : context.solutions) {
      if (solution.source == 0 && solution.method == method) return &solution;
    }
  }
  return nullptr;
}

/// (x_f - x_s) / sqrt(P_f - P_s) of one component, of a forward filter and the
/// smoother of the same tape. With P_s^-1 = P_f^-1 + P_b^-1 it is, component by
/// component, (x_f - x_b) / sqrt(P_f + P_b) of forward and backward filter. NaN
/// where the backward filter adds next to nothing.
std::vector<double> OverItsSigma(const std::vector<double>& x_f,
                                 const std::vector<double>& x_s,
                                 const std::vector<double>& sd_f,
                                 const std::vector<double>& sd_s, bool angle) {
  constexpr double kLeastGain = 0.02;  // of the variance
  std::vector<double> ratio(x_f.size(),
                            std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < x_f.size(); ++k) {
    const double P_f = sd_f[k] * sd_f[k];
    const double variance = P_f - sd_s[k] * sd_s[k];
    if (!(variance > kLeastGain * P_f)) continue;
    double difference = x_f[k] - x_s[k];
    if (angle) difference = std::remainder(difference, 360.0);
    ratio[k] = difference / std::sqrt(variance);
  }
  return ratio;
}

struct Component {
  const char* name;
  const char* column;  ///< on the page, or in METHOD.csv
  const char* sigma;   ///< in METHOD.csv
};

constexpr Component kComponents[] = {
    {"North", "north", "sd_n[m]"},
    {"East", "east", "sd_e[m]"},
    {"Height", "height", "sd_d[m]"},
    {"Velocity north", "v_n[m/s]", "sd_v_n[m/s]"},
    {"Velocity east", "v_e[m/s]", "sd_v_e[m/s]"},
    {"Velocity down", "v_d[m/s]", "sd_v_d[m/s]"},
    {"Roll", "roll[deg]", "sd_roll[deg]"},
    {"Pitch", "pitch[deg]", "sd_pitch[deg]"},
    {"Heading", "heading[deg]", "sd_heading[deg]"},
};

const std::vector<double>* ColumnOf(const ReportContext& context,
                                    const ReportSolution& solution,
                                    const std::string& name) {
  const auto own = solution.columns.find(name);
  if (own != solution.columns.end()) return &own->second;
  const auto& shown = context.data.table(solution.table).columns;
  const auto column = shown.find(name);
  return column == shown.end() ? nullptr : &column->second;
}

/// A chart for each component in which forward filter and smoother differ.
std::string ComponentFigures(ReportContext* context) {
  const ReportSolution* forward = FindSolution(*context, {"ekf"});
  const ReportSolution* smoother =
      FindSolution(*context, {"two_filter", "rts"});
  if (forward == nullptr || smoother == nullptr ||
      forward->t() != smoother->t()) {
    return "";
  }
  ReportSeries series;
  series.t = forward->t();
  for (const Component& c : kComponents) {
    const auto* x_f = ColumnOf(*context, *forward, c.column);
    const auto* x_s = ColumnOf(*context, *smoother, c.column);
    const auto* sd_f = ColumnOf(*context, *forward, c.sigma);
    const auto* sd_s = ColumnOf(*context, *smoother, c.sigma);
    if (!x_f || !x_s || !sd_f || !sd_s) continue;
    const bool angle = std::string(c.column).ends_with("[deg]");
    series.columns[c.name] = OverItsSigma(*x_f, *x_s, *sd_f, *sd_s, angle);
  }
  const int table = context->data.Add(std::move(series));
  std::string figures;
  for (const Component& c : kComponents) {
    figures +=
        context->data.Figure({.title = c.name,
                              .unit = "sigma",
                              .lines = {{.table = table,
                                         .column = c.name,
                                         .label = "forward minus backward",
                                         .colour = 2}},
                              .levels = {-3.0, -2.0, 2.0, 3.0}});
  }
  return figures;
}

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

void AddSolutionSeries(ReportContext* context) {
  std::optional<Geodetic> origin;
  for (std::size_t i = 0; i < context->solutions.size(); ++i) {
    ReportSolution& solution = context->solutions[i];
    ReportSeries series;
    series.t = solution.t();
    for (const Shown& shown : kShown) {
      const auto column = solution.columns.find(shown.title);
      if (column == solution.columns.end()) continue;
      series.columns[shown.name] = column->second;
    }
    if (solution.Has("lat[deg]") && solution.Has("h[m]")) {
      if (!origin) {
        origin = Geodetic{solution.columns.at("lat[deg]")[0] * kDegree,
                          solution.columns.at("lon[deg]")[0] * kDegree,
                          solution.columns.at("h[m]")[0]};
      }
      AddPlace(solution, *origin, &series.columns);
    }
    AddLength("sd_n", "sd_e", "sd_h", &series.columns);
    AddLength("sd_v_n", "sd_v_e", "sd_v_h", &series.columns);
    AddLength("sd_roll", "sd_pitch", "sd_tilt", &series.columns);
    AddLength("v_n", "v_e", "speed", &series.columns);
    series.detail = IsShownWhole(solution, i) ? ReportDetail::kFull
                                              : ReportDetail::kExtremes;
    if (context->solutions.size() > 1 || series.columns.contains("north")) {
      solution.samples = context->data.Add(SomeRows(series));
    }
    if (i > 0) EraseWhatOnlyTheFirstShows(&series.columns);
    solution.table = context->data.Add(std::move(series));
  }
  if (origin) {
    context->map["origin"] = {origin->latitude / kDegree,
                              origin->longitude / kDegree, origin->height};
  }
}

std::string AccuracyPanel(ReportContext* context) {
  constexpr Quantity kQuantities[] = {
      {"sd_h", "Horizontal position", "m"},
      {"sd_d", "Height", "m"},
      {"sd_v_h", "Horizontal velocity", "m/s"},
      {"sd_v_d", "Vertical velocity", "m/s"},
      {"sd_tilt", "Tilt (roll and pitch)", "deg"},
      {"sd_heading", "Heading", "deg"},
  };
  std::string figures;
  for (const Quantity& q : kQuantities) {
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
              ? Absent("By component: none, as it takes ekf and two_filter or "
                       "rts.")
              : "<h3>By component</h3>\n" +
                    Element("p",
                            "Forward minus backward over its standard "
                            "deviation, found as (x_f - x_s) / sqrt(P_f - "
                            "P_s) of ekf and its smoother. Left open where "
                            "the backward filter knows next to nothing.") +
                    Grid(components, ""));
}

std::string MotionPanel(ReportContext* context) {
  constexpr Quantity kQuantities[] = {
      {"height", "Height above the ellipsoid", "m"},
      {"speed", "Horizontal speed", "m/s"},
      {"v_d", "Velocity down", "m/s"},
      {"roll", "Roll", "deg"},
      {"pitch", "Pitch", "deg"},
      {"heading", "Heading", "deg"},
  };
  std::string figures;
  for (const Quantity& q : kQuantities) {
    figures += context->data.Figure({.title = q.title,
                                     .unit = q.unit,
                                     .lines = LinesOf(*context, q.column)});
  }
  return Grid(figures, "The solutions hold no motion.");
}

std::string DifferencePanel(ReportContext* context) {
  if (context->solutions.size() < 2) {
    return Absent("There is one solution only.");
  }
  constexpr Quantity kQuantities[] = {
      {"north", "North", "m"},         {"east", "East", "m"},
      {"height", "Height", "m"},       {"v_n", "Velocity north", "m/s"},
      {"v_e", "Velocity east", "m/s"}, {"v_d", "Velocity down", "m/s"},
      {"roll", "Roll", "deg"},         {"pitch", "Pitch", "deg"},
      {"heading", "Heading", "deg"},
  };
  std::string figures;
  for (const Quantity& q : kQuantities) {
    std::vector<ChartLine> lines = LinesOf(*context, q.column);
    for (ChartLine& line : lines) {
      line.table =
          context->solutions[static_cast<std::size_t>(line.group)].samples;
    }
    figures += context->data.Figure(
        {.title = q.title, .unit = q.unit, .lines = lines, .difference = true});
  }
  return "<p>Each solution minus <span id=\"base\">" + context->best().label +
         "</span>. Dashed, in the colour of the solution: the standard "
         "deviation that the difference may have, sqrt|P - P of the other|, "
         "of two smoothers the other's own sigma. Drawn at up to 800 "
         "epochs.</p>\n" +
         Grid(figures, "The solutions have no quantity in common.");
}

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

std::string TruthPanel(ReportContext* context) {
  constexpr Quantity kErrors[] = {
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
                           IsShownWhole(solution, tables.size())
                               ? ReportDetail::kFull
                               : ReportDetail::kExtremes};
    series.columns.erase("t[s]");
    if (!tables.empty()) EraseWhatOnlyTheFirstShows(&series.columns);
    tables.push_back(context->data.Add(std::move(series)));
  }
  std::string figures;
  for (const Quantity& q : kErrors) {
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
        "METHOD.errors.csv (of attitude alone none is written).");
  }
  return Element("p",
                 "Truth minus solution. Dashed: three sigma of the "
                 "recommended solution. The grades know nothing of it.") +
         Grid(figures, "");
}

}  // namespace hindsight
