#include <algorithm>
#include <cmath>

#include "evaluation/statistics.h"
#include "problems/navigation_trial.h"

namespace hindsight {
namespace {

double LargestMagnitude(const std::vector<double>& values) {
  return std::max(Largest(values), -Least(values));
}

/// Of each axis of the position.
Figure PositionFigure(const std::string& name, const std::string& title,
                      const Reduce& reduce, TimeRange range = {}) {
  return Several(name, kMetres, title, "{:.3f}",
                 {{"n", "position_n", reduce},
                  {"e", "position_e", reduce},
                  {"d", "position_d", reduce}},
                 range);
}

Figure AneesFigure(const std::string& name, const std::string& title,
                   TimeRange range = {}) {
  return Several(name, kPlain, title, "{:.1f}",
                 {{"", "nees", OfCurve<Mean, Mean>}}, range);
}

double RowNis(const RunCell& cell, const std::string&, const TimeRange&) {
  return Mean(cell.Values("nis_sum")) / Mean(cell.Values("nis_rows"));
}

/// Legs are open at their beginnings, which belong to the legs before; the last
/// has no end.
std::vector<TimeRange> Legs(const std::vector<double>& ends) {
  std::vector<TimeRange> legs(ends.size());
  for (std::size_t i = 0; i + 1 < legs.size(); ++i) {
    legs[i].to = ends[i];
    legs[i + 1].from = std::nextafter(ends[i], ends[i + 1]);
  }
  return legs;
}

/// What the second part of the printed table holds.
std::vector<Figure> ErrorFigures() {
  std::vector<Figure> figures = {
      PositionFigure("max_mean", "mean error [m]\nmax N E D",
                     OfCurve<LargestMagnitude, Mean>),
      Single("position_rms", kMetres, "position\nrms [m]", "{:.3f}",
             OfRuns<Rms>),
      Single("position_max", kMetres, "max\n[m]", "{:.3f}", OfRuns<Largest>),
      Single("end_horizontal", kMetres, "end, horiz.\nrms [m]", "{:.3f}",
             OfRuns<Rms>),
      Single("heading_rms", kDegrees, "heading\nrms [deg]", "{:.3f}",
             OfRuns<Rms>),
      Single("attitude_rms", kDegrees, "attitude\nrms [deg]", "{:.3f}",
             OfRuns<Rms>),
      Single("position_nees", kPlain, "NEES (3)\nposition", "{:.2f}",
             OfRuns<Mean>),
      Single("attitude_nees", kPlain, "NEES (3)\nattitude", "{:.2f}",
             OfRuns<Mean>),
      Share("outside_5_sigma", "beyond\n5 sigma [%]", "outside_5_sigma",
            OfRuns<Mean>)};
  for (Figure& figure : figures) figure.part = 1;
  return figures;
}

StudyTable Cells(const std::vector<double>& leg_ends) {
  StudyTable table = {"cells", {"method"}, {}, {}};
  std::vector<Figure>& figures = table.figures;
  std::vector<Figure> leg_anees;
  figures.push_back(PositionFigure("max_std", "max std [m]\nN E D",
                                   OfCurve<Largest, StandardDeviation>));
  for (const TimeRange& leg : Legs(leg_ends)) {
    const std::string number = std::to_string(leg_anees.size() + 1);
    figures.push_back(PositionFigure("leg" + number + "_max_std",
                                     "leg " + number + " [m]\nN E D",
                                     OfCurve<Largest, StandardDeviation>, leg));
    leg_anees.push_back(AneesFigure("leg" + number + "_anees",
                                    leg_anees.empty() ? "ANEES\nleg 1" : "",
                                    leg));
  }
  figures.insert(figures.end(),
                 {PositionFigure("end_std", "end [m]\nN E D",
                                 OfCurve<Last, StandardDeviation>),
                  Single("yaw_std", kDegrees, "yaw\n[deg]", "{:.4f}", "yaw",
                         OfCurve<Largest, StandardDeviation>),
                  AneesFigure("anees", "ANEES\nall")});
  figures.insert(figures.end(), leg_anees.begin(), leg_anees.end());
  figures.insert(figures.end(),
                 {AneesBoundFigure("95 %\nbounds", "{:.1f}"),
                  Share("anees_outside", "outside\n[%]", "nees", AneesOutside),
                  Single("nis", kPlain, "NIS\nper row", "{:.3f}", "", RowNis),
                  Single("states", kPlain, "", "", OfRuns<Largest>),
                  FailedFigure(), GradesFigure(), SecondsFigure()});
  for (Figure& figure : ErrorFigures()) figures.push_back(std::move(figure));
  table.curves = {{"std_n", kMetres, "position_n", StandardDeviation},
                  {"std_e", kMetres, "position_e", StandardDeviation},
                  {"std_d", kMetres, "position_d", StandardDeviation},
                  {"std_yaw", kDegrees, "yaw", StandardDeviation},
                  {"anees", kPlain, "nees", Mean}};
  table.folds_series = true;
  return table;
}

/// Each constant by its errors over its sigmas, one at a time.
StudyTable Constants() {
  StudyTable table = {"constants", {"method", "constant", "unit"}, {}, {}};
  table.figures = {
      Single("prior_sigma", kPlain, "prior\nsigma", "{:.3g}", OfRuns<Largest>),
      Single("sigma", kPlain, "sigma\nmean", "{:.3g}", OfRuns<Mean>),
      Single("rms", kPlain, "error\nrms", "{:.3g}", "error", OfRuns<Rms>),
      Single("anees", kPlain, "(error/sigma)^2\nmean", "{:.2f}", "nees",
             OfRuns<Mean>),
      AneesBoundFigure("99.9 %\nbounds", "{:.2f}", 0.999),
      Single("observed", kPlain, "ob-\nserved", "{:.0f}", OfRuns<Sum>),
      Single("unobserved", kPlain, "un-\nobserved", "{:.0f}", OfRuns<Sum>)};
  return table;
}

StudyTable Agreement() {
  StudyTable table = {"agreement", {"method", "with"}, {}, {}};
  table.figures = {
      Single("position", kMetres, "largest distance\n[m]", "{:.3g}",
             OfRuns<Largest>),
      Single("attitude", {"rad", 1.0}, "[rad]", "{:.3g}", OfRuns<Largest>),
      Single("position_after_first_leg", kMetres, "after the first\nleg [m]",
             "{:.3g}", OfRuns<Largest>)};
  return table;
}

/// Percentiles over the outages of all runs of the largest error in each.
StudyTable Outages() {
  StudyTable table = {"outages", {"outage", "sensor", "method"}, {}, {}};
  for (const std::string name : {"horizontal", "vertical"}) {
    table.figures.push_back(Several(
        name, kMetres, "largest " + name + " error [m]\n50, 68, 95 %", "{:.3f}",
        {{"p50", name, OfRuns<Rank50>},
         {"p68", name, OfRuns<Rank68>},
         {"p95", name, OfRuns<Rank95>}}));
  }
  return table;
}

}  // namespace

std::vector<StudyTable> NavigationTables(const std::vector<double>& leg_ends) {
  return {Cells(leg_ends), Constants(), Agreement(), Outages()};
}

}  // namespace hindsight
