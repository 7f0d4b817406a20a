#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/finished_runs.h"
#include "app/flags.h"
#include "app/montecarlo_report.h"
#include "app/montecarlo_scenarios.h"
#include "app/progress.h"
#include "app/result_folder.h"
#include "app/tunnel_flags.h"
#include "base/text.h"
#include "io/table.h"

namespace hindsight {
namespace {

MonteCarloCase CaseOf(const TunnelSurveyOptions& options, std::string suffix,
                      std::vector<std::string> methods) {
  const auto recording =
      std::make_shared<const PerfectRecording>(TunnelSurvey(options));
  return {std::move(suffix),
          [recording](std::uint64_t seed) { return recording->Realize(seed); },
          std::move(methods)};
}

void Compare(const TunnelSurveyOptions& survey, MonteCarloOptions options,
             ResultFolder* folder) {
  TunnelSurveyOptions forward_only = survey;
  forward_only.odometer_form = Odometer::Form::kForward;
  const std::vector<MonteCarloCase> cases = {
      CaseOf(survey, "",
             {"ekf", "two_filter", "two_filter_conventional",
              "two_filter_euler", "rts", "iterated", "batch"}),
      CaseOf(forward_only, "_forward_odometer",
             {"ekf", "two_filter", "iterated", "batch"})};
  options.leg_ends = ReferenceTimes(survey.reference_spacing);
  const auto files = [options](const MonteCarloResult& all, bool complete) {
    return MonteCarloFiles({kTunnelSurveyName, FLAGS_path, FLAGS_white_noise,
                            options.runs, options.first_seed, complete},
                           all);
  };
  const MonteCarloResult result = RunMonteCarlo(
      cases, options, KeepFinishedRuns<MonteCarloResult>(folder, files));
  std::cout << "tunnel_survey, path " << FLAGS_path << ", noise "
            << FLAGS_white_noise << ", seeds " << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\n\n"
            << MonteCarloTable(result) << "\nLargest differences:\n"
            << AgreementText(result);
  CommitFiles(files(result, true), folder);
}

/// montecarlo.json of a sweep, whose figures are in sweep.csv.
std::string SweepJson(const MonteCarloOptions& options, bool complete) {
  const nlohmann::ordered_json json = {{"scenario", kTunnelSurveyName},
                                       {"path", FLAGS_path},
                                       {"noise", FLAGS_white_noise},
                                       {"sweep", true},
                                       {"complete", complete},
                                       {"runs", options.runs},
                                       {"first_seed", options.first_seed}};
  return json.dump(2) + "\n";
}

/// Largest standard deviation of any axis at any time, per spacing and noise.
void Sweep(TunnelSurveyOptions survey, const MonteCarloOptions& options,
           Progress* progress, ResultFolder* folder) {
  constexpr double kSpacings[] = {250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0};
  constexpr double kSigmas[] = {0.005, 0.01, 0.02, 0.05, 0.1};
  constexpr double kCells = std::size(kSpacings) * std::size(kSigmas);
  std::vector<std::string> heading = {"odometer noise\n[mm/s]"};
  for (const double spacing : kSpacings) {
    heading.push_back(Format("%.2f km\ntwo_filter  batch", spacing / 1000.0));
  }
  ReportTable table(heading);
  std::string csv =
      "reference_spacing[m],odometer_sigma[m/s],method,max_std_n[m],"
      "max_std_e[m],max_std_d[m],anees[1]\n";
  int cells_done = 0;
  for (const double sigma : kSigmas) {
    std::vector<std::string> row = {Format("%.0f", 1000.0 * sigma)};
    for (const double spacing : kSpacings) {
      survey.odometer_sigma = sigma;
      survey.reference_spacing = spacing;
      const MonteCarloResult result =
          RunMonteCarlo({CaseOf(survey, "", {"two_filter", "batch"})}, options);
      std::string cell;
      for (const MethodStatistics& m : result.methods) {
        cell +=
            Format("%s%.3f", cell.empty() ? "" : "  ", m.max_std.maxCoeff());
        csv += Format("%g,%g,%s,%.6g,%.6g,%.6g,%.6g\n", spacing, sigma,
                      m.name.c_str(), m.max_std.x(), m.max_std.y(),
                      m.max_std.z(), m.anees);
      }
      row.push_back(cell);
      folder->Write({"sweep.csv", csv});
      folder->Keep(kMonteCarloJson, SweepJson(options, false));
      progress->Update("sweep", ++cells_done / kCells);
    }
    table.AddRow(row);
  }
  progress->Clear();
  std::cout << "tunnel_survey, path " << FLAGS_path << ", noise "
            << FLAGS_white_noise << ", " << options.runs
            << " runs a cell: largest standard deviation of an axis [m]\nby "
               "distance of the reference points\n\n"
            << table.Render();
  folder->Commit(kMonteCarloJson, SweepJson(options, true));
}

}  // namespace

void RunTunnelSurvey(MonteCarloOptions options, Progress* progress,
                     ResultFolder* folder) {
  const TunnelSurveyOptions survey = ReadTunnelFlags();
  if (FLAGS_sweep) {
    Sweep(survey, options, progress, folder);
  } else {
    options.progress = RunProgress(options.runs, progress);
    Compare(survey, options, folder);
  }
}

}  // namespace hindsight
