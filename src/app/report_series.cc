#include <cmath>
#include <optional>

#include "app/report_lines.h"
#include "base/units.h"
#include "earth/wgs84.h"

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
    series.detail = DetailOf(solution, i);
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

}  // namespace hindsight
