#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/flags.h"
#include "app/list_flags.h"
#include "app/montecarlo_report.h"
#include "app/montecarlo_scenarios.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "io/table.h"
#include "problems/uuv_fusion.h"
#include "simulation/uuv_path.h"
#include "simulation/uuv_scenarios.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

UuvTruth SearchTruth() {
  const UuvPath path = MakeUuvPath("lawnmower");
  UuvTruth truth;
  for (double t = 0.0; t <= path.duration(); t += 1.0) {
    const PathPoint at = path.At(t);
    ErrorVector x(6);
    x << at.p_n.x(), at.v_n.x(), at.p_n.y(), at.v_n.y(), at.p_n.z(), at.v_n.z();
    truth.push_back(x);
  }
  return truth;
}

Json ToJson(const DistanceError& error) {
  return {{"mean_m", error.mean},
          {"std_m", error.deviation},
          {"bin_m", error.bin},
          {"histogram", error.histogram}};
}

/// One line an architecture; the same figures into the JSON object.
void AddRows(const std::string& reading,
             const std::vector<UuvFusionResult>& results, ReportTable* table,
             Json* json) {
  for (const UuvFusionResult& r : results) {
    const char* name = FusionName(r.architecture);
    table->AddRow(
        {name == FusionName(kFusionArchitectures[0]) ? reading : "", name,
         Format("%.3f", r.spatial.mean), Format("%.3f", r.spatial.deviation),
         Format("%.3f", r.horizontal.mean),
         Format("%.3f", r.horizontal.deviation), Format("%.3g", r.nees)});
    (*json)[reading][name] = {{"spatial", ToJson(r.spatial)},
                              {"horizontal", ToJson(r.horizontal)},
                              {"nees", r.nees}};
  }
}

ReportTable FusionTable() {
  return ReportTable({"reading", "architecture", "3-D mean\n[m]", "std\n[m]",
                      "2-D mean\n[m]", "std\n[m]", "NEES\n/ 6"});
}

/// One path with or without fix and gap.
struct SurveyCase {
  const char* title;
  UuvSurveyOptions options;
};

double LengthOf(const UuvPath& path) {
  constexpr double kStep = 0.5;
  double length = 0.0;
  for (double t = 0.5 * kStep; t < path.duration(); t += kStep) {
    length += kStep * path.At(t).v_n.norm();
  }
  return length;
}

void AddSurvey(const SurveyCase& c, const MonteCarloOptions& options,
               ReportTable* table, Json* json) {
  const auto recording =
      std::make_shared<const PerfectRecording>(UuvSurvey(c.options));
  const MonteCarloResult result = RunMonteCarlo(
      {{"",
        [recording](std::uint64_t seed) { return recording->Realize(seed); },
        {"ekf", "two_filter", "rts", "batch"}}},
      options);
  const double length = LengthOf(MakeUuvPath(c.options.path));
  const std::string key = c.options.path + ", " + c.title;
  for (const MethodStatistics& m : result.methods) {
    if (m.t.empty()) continue;
    const double drift = m.final_horizontal / length;
    table->AddRow(
        {&m == &result.methods.front() ? key : "", m.name,
         Format("%.3f", m.position_rms), Format("%.3f", m.final_horizontal),
         Format("%.3f", 100.0 * drift), Format("%.3f", m.heading_rms / kDegree),
         Format("%.2f", m.position_nees / 3.0),
         m.failed > 0 ? std::to_string(m.failed) : "", GradesCell(m),
         Format("%.2f", m.seconds)});
    (*json)[key][m.name] = {{"position_rms_m", m.position_rms},
                            {"end_horizontal_m", m.final_horizontal},
                            {"end_drift", drift},
                            {"heading_rms_deg", m.heading_rms / kDegree},
                            {"position_nees", m.position_nees},
                            {"failed", m.failed},
                            {"seconds_per_run", m.seconds}};
  }
}

/// The path that --path asks for, or all.
std::vector<std::string> SurveyPaths() {
  std::vector<std::string> paths = UuvPathNames();
  if (!IsGiven("path")) return paths;
  if (std::find(paths.begin(), paths.end(), FLAGS_path) == paths.end()) {
    throw UsageError("--path=" + FLAGS_path +
                     ": expected lawnmower, straight or returning" +
                     Suggestion(FLAGS_path, paths));
  }
  return {FLAGS_path};
}

}  // namespace

void RunUuvSearch(MonteCarloOptions options, Progress* progress,
                  ResultFolder* folder) {
  constexpr int kEpochs = 1000;
  UuvFusionOptions fusion;
  fusion.runs = options.runs;
  fusion.first_seed = options.first_seed;
  ReadWords("reading", FLAGS_reading);
  std::vector<UuvReading> readings;
  try {
    readings = UuvReadings(FLAGS_reading);
  } catch (const InputError& error) {
    throw UsageError("--reading: " + std::string(error.what()));
  }
  const UuvTruth truth = SearchTruth();
  ReportTable table = FusionTable();
  Json json;
  json["scenario"] = kUuvSearchName;
  json["complete"] = false;
  json["runs"] = options.runs;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (options.stop != nullptr && *options.stop) throw Interrupted();
    AddRows(readings[i].Name(), SolveUuvFusion(truth, readings[i], fusion),
            &table, &json["readings"]);
    folder->Keep(kMonteCarloJson, json.dump(1) + "\n");
    progress->Update("readings", static_cast<double>(i + 1) /
                                     static_cast<double>(readings.size()));
  }
  ReportTable matched = FusionTable();
  for (const auto& [name, sigma] :
       {std::pair("sensors of 9.8 m and 0.02 m", std::array{9.8, 0.02}),
        std::pair("two sensors of 9.8 m", std::array{9.8, 9.8})}) {
    AddRows(name, SolveMatchedFusion(kEpochs, sigma, fusion), &matched,
            &json["matched"]);
  }
  progress->Clear();
  std::cout << "uuv_search, " << options.runs << " runs of " << kEpochs
            << " s; the paper has 3-D 3.67 (std 1.01) central, 1.83 (1.53) "
               "track to\ntrack, 1.38 (0.32) equalised; 2-D 3.57, 2.70, "
               "1.07\n\n"
            << table.Render()
            << "\nWith a truth that moves as the filters think (NEES / 6 "
               "should be 1):\n\n"
            << matched.Render();
  json["complete"] = true;
  folder->Commit(kMonteCarloJson, json.dump(1) + "\n");
}

void RunUuvSurvey(MonteCarloOptions options, Progress* progress,
                  ResultFolder* folder) {
  constexpr double kGap = 120.0;
  ReportTable table({"dive", "method", "position\nrms [m]",
                     "end, horiz.\nrms [m]", "of distance\n[%]",
                     "heading\nrms [deg]", "NEES pos.\n/ 3", "failed",
                     kGradesTitle, "s/run"});
  Json json;
  json["scenario"] = kUuvSurveyName;
  json["complete"] = false;
  json["runs"] = options.runs;
  for (const std::string& path : SurveyPaths()) {
    for (const SurveyCase& c :
         {SurveyCase{"no fix", {.path = path, .final_fix = false}},
          SurveyCase{"final fix", {.path = path}},
          SurveyCase{"final fix, 120 s without DVL",
                     {.path = path, .gap = kGap}}}) {
      options.progress = RunProgress(options.runs, progress);
      AddSurvey(c, options, &table, &json["dives"]);
      folder->Keep(kMonteCarloJson, json.dump(2) + "\n");
    }
  }
  std::cout << "uuv_survey, seeds " << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\n\n"
            << table.Render();
  json["complete"] = true;
  folder->Commit(kMonteCarloJson, json.dump(2) + "\n");
}

}  // namespace hindsight
