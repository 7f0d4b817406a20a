#include <algorithm>
#include <cmath>

#include "evaluation/statistics.h"
#include "problems/navigation_trial.h"

namespace hindsight {
namespace {

double LargestMagnitude(const std::vector<double>& values) {
  return std::max(Largest(values), -Least(values));
}

double TotalMost(const PartErrors& part) { return Largest(part.Norms()); }
double EndLevel(const PartErrors& part) { return part.Level().back(); }

/// Over the rows of all runs.
double RowNis(const RunCell& cell, const std::string&) {
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

StudyTable Cells(const std::vector<double>& leg_ends) {
  constexpr auto kScatter = SeriesFold::Deviation;
  StudyTable table = {"cells", {"method"}};
  table.AddAxes({"max_std", kMetres, OfCurve(Largest, kScatter), "position"});
  std::string leg = "leg0";
  for (const TimeRange& range : Legs(leg_ends)) {
    ++leg.back();
    table.AddAxes({leg + "_max_std", kMetres, OfCurve(Largest, kScatter, range),
                   "position"});
    table.Add({{leg + "_anees", kPlain, OfCurve(Mean, SeriesFold::Mean, range),
                "nees"}});
  }
  table.AddAxes({"end_std", kMetres, OfCurve(Last, kScatter), "position"});
  table.Add({{"yaw_std", kDegrees, OfCurve(Largest, kScatter), "yaw"},
             {"anees", kPlain, OfCurve(Mean, SeriesFold::Mean), "nees"}});
  table.AddAneesBounds();
  table.Add({{"anees_outside", kPlain, AneesOutside, "nees"},
             {"nis", kPlain, RowNis},
             {"states", kPlain, OfRuns(Largest)},
             FailedFigure()});
  table.AddGrades();
  table.Add({SecondsFigure()});
  table.AddAxes({"max_mean", kMetres,
                 OfCurve(LargestMagnitude, SeriesFold::Mean), "position"});
  const auto position = &StateErrors::position;
  const auto attitude = &StateErrors::attitude;
  table.Add(
      {Measured("position_rms", kMetres, Rms, OfPart(position, TotalRms)),
       Measured("position_max", kMetres, Largest, OfPart(position, TotalMost)),
       Measured("end_horizontal", kMetres, Rms, OfPart(position, EndLevel)),
       Measured("heading_rms", kDegrees, Rms,
                [](const StateErrors& errors) { return Rms(errors.yaw); }),
       Measured("attitude_rms", kDegrees, Rms, OfPart(attitude, TotalRms)),
       Measured("position_nees", kPlain, Mean, OfPart(position, MeanNees)),
       Measured("attitude_nees", kPlain, Mean, OfPart(attitude, MeanNees)),
       Measured("outside_5_sigma", kPlain, Mean, [](const StateErrors& errors) {
         return errors.ShareBeyond(5.0);
       })});
  for (int axis = 0; axis < 3; ++axis) {
    table.series.emplace_back(
        std::string("position_") + "ned"[axis],
        [axis](const StateErrors& e) { return e.position.Component(axis); });
  }
  table.series.emplace_back("yaw", [](const auto& e) { return e.yaw; });
  table.series.emplace_back("nees", [](const auto& e) { return e.nees; });
  table.curves = {{"std_n", kMetres, "position_n", kScatter},
                  {"std_e", kMetres, "position_e", kScatter},
                  {"std_d", kMetres, "position_d", kScatter},
                  {"std_yaw", kDegrees, "yaw", kScatter},
                  {"anees", kPlain, "nees", SeriesFold::Mean}};
  return table;
}

/// Each constant by its errors over its sigmas, one at a time.
StudyTable Constants() {
  constexpr double kConfidence = 0.999;
  StudyTable table = {"constants", {"method", "constant", "unit"}};
  table.Add({{"prior_sigma", kPlain, OfRuns(Largest)},
             {"sigma", kPlain, OfRuns(Mean)},
             {"rms", kPlain, OfRuns(Rms), "error"},
             {"anees", kPlain, OfRuns(Mean), "nees"}});
  table.AddAneesBounds(kConfidence);
  table.Add(
      {{"observed", kPlain, OfRuns(Sum)}, {"unobserved", kPlain, OfRuns(Sum)}});
  return table;
}

}  // namespace

std::vector<StudyTable> NavigationTables(const std::vector<double>& leg_ends) {
  StudyTable agreement = {"agreement", {"method", "with"}};
  agreement.Add({{"position", kMetres, OfRuns(Largest)},
                 {"attitude", {"rad", 1.0}, OfRuns(Largest)},
                 {"position_after_first_leg", kMetres, OfRuns(Largest)}});
  // Over the outages of all runs, of the largest error in each.
  StudyTable outages = {"outages", {"outage", "sensor", "method"}};
  for (const std::string name : {"horizontal", "vertical"}) {
    outages.Add({{name + "_p50", kMetres, OfRuns(Rank50), name},
                 {name + "_p68", kMetres, OfRuns(Rank68), name},
                 {name + "_p95", kMetres, OfRuns(Rank95), name}});
  }
  return {Cells(leg_ends), Constants(), agreement, outages};
}

}  // namespace hindsight
