#include <cmath>
#include <limits>

#include "app/report_html.h"
#include "app/report_lines.h"

namespace hindsight {
namespace {

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

}  // namespace hindsight
