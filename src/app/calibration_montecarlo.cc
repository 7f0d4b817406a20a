#include <iostream>
#include <memory>
#include <utility>

#include "app/finished_runs.h"
#include "app/flags.h"
#include "app/montecarlo_report.h"
#include "app/montecarlo_scenarios.h"
#include "base/text.h"
#include "evaluation/chi_square.h"
#include "io/table.h"
#include "simulation/calibration_drive.h"
#include "simulation/uuv_scenarios.h"

namespace hindsight {
namespace {

constexpr double kDuration = 600.0;
constexpr double kJudgedEvery = 10.0;  // of truth, away from the ends [s]

std::string Verdicts(const ConstantStatistics& c) {
  if (c.observed == c.runs) return "observed";
  if (c.unobserved == c.runs) return "unobserved";
  return Format("%d observed, %d weak, %d unobserved", c.observed,
                c.runs - c.observed - c.unobserved, c.unobserved);
}

/// One line a constant; the bounds are those of one constant at a time.
std::string ConstantTable(const MethodStatistics& method) {
  ReportTable table({"constant", "prior\nsigma", "sigma\nmean", "error\nrms",
                     "(error/sigma)^2\nmean", "99.9 %\nbounds", "verdict"});
  for (const ConstantStatistics& c : method.constants) {
    const Interval bounds = AneesBounds(c.runs, 1, 0.999);
    table.AddRow({c.name + " [" + c.unit + "]", Format("%.3g", c.prior_sigma),
                  Format("%.3g", c.sigma), Format("%.3g", c.rms),
                  Format("%.2f", c.anees),
                  Format("%.2f %.2f%s", bounds.lower, bounds.upper,
                         bounds.Contains(c.anees) ? "" : " outside"),
                  Verdicts(c)});
  }
  return table.Render();
}

void RunConstants(const char* name, const Scenario& scenario,
                  MonteCarloOptions options, Progress* progress,
                  ResultFolder* folder) {
  const auto recording = std::make_shared<const PerfectRecording>(scenario);
  for (double t = kJudgedEvery; t < kDuration; t += kJudgedEvery) {
    options.node_times.push_back(t);
  }
  options.progress = RunProgress(options.runs, progress);
  const auto files = [name, options](const MonteCarloResult& all,
                                     bool complete) {
    return MonteCarloFiles(
        {name, "", "", options.runs, options.first_seed, complete}, all);
  };
  const MonteCarloResult result = RunMonteCarlo(
      {{"",
        [recording](std::uint64_t seed) { return recording->Realize(seed); },
        {"ekf", "rts", "iterated", "batch"}}},
      options, KeepFinishedRuns<MonteCarloResult>(folder, files));
  std::cout << name << ", " << options.runs << " runs, " << result.dim
            << " states\n\n"
            << MonteCarloTable(result);
  for (const MethodStatistics& method : result.methods) {
    if (method.name != "ekf" && method.name != "batch") {
      continue;
    }
    std::cout << "\n" << method.name << ":\n" << ConstantTable(method);
  }
  CommitFiles(files(result, true), folder);
}

}  // namespace

void RunCalibration(MonteCarloOptions options, Progress* progress,
                    ResultFolder* folder) {
  RunConstants(kCalibrationName, CalibrationDrive(kDuration),
               std::move(options), progress, folder);
}

void RunUuvCalibration(MonteCarloOptions options, Progress* progress,
                       ResultFolder* folder) {
  RunConstants(kUuvCalibrationName, UuvCalibration(), std::move(options),
               progress, folder);
}

}  // namespace hindsight
