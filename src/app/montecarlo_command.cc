#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include "app/command.h"
#include "app/flags.h"
#include "app/interrupt.h"
#include "app/montecarlo_report.h"
#include "app/progress.h"
#include "app/result_folder.h"
#include "app/text.h"
#include "app/tunnel_flags.h"
#include "evaluation/chi_square.h"
#include "io/atomic_file.h"
#include "io/table.h"

namespace hindsight {
namespace {

constexpr char kJsonName[] = "montecarlo.json";

constexpr const char* kHelp =
    R"(Repeats a built-in scenario with other seeds and compares what each method
makes of it: standard deviation of the position over the runs (largest over
time, north, east, down, all and by leg), heading, consistency (ANEES of the
whole state, NIS), processor time. SCENARIO is tunnel_survey. Writes into the
folder of --out:
  montecarlo.json   the figures of all methods and how far they agree
  METHOD.csv        standard deviations and ANEES against time
  sweep.csv         with --sweep in place of both: largest standard deviation
                    for reference points every 0.25 to 8 km and odometer noise
                    of 5 to 100 mm/s
The figures do not depend on the number of threads.
)";

MonteCarloCase CaseOf(const TunnelSurveyOptions& options, std::string suffix,
                      std::vector<Method> methods) {
  const auto recording =
      std::make_shared<const PerfectRecording>(TunnelSurvey(options));
  return {std::move(suffix),
          [recording](std::uint64_t seed) { return recording->Realize(seed); },
          std::move(methods)};
}

MonteCarloOptions ReadOptions() {
  if (FLAGS_runs < 2 || FLAGS_runs > 1000000) {
    throw UsageError("--runs=" + std::to_string(FLAGS_runs) +
                     ": expected 2 to 1000000");
  }
  constexpr std::uint64_t kMostThreads = 1024;
  if (FLAGS_threads > kMostThreads) {
    throw UsageError("--threads=" + std::to_string(FLAGS_threads) +
                     ": expected 0 to 1024");
  }
  MonteCarloOptions options;
  options.runs = static_cast<int>(FLAGS_runs);
  options.first_seed = FLAGS_seed;
  options.threads =
      FLAGS_threads > 0
          ? static_cast<int>(FLAGS_threads)
          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  options.anees_bounds = [](int runs, int dim) {
    const Interval bounds = AneesBounds(runs, dim, 0.95);
    return std::pair(bounds.lower, bounds.upper);
  };
  options.stop = &StopRequested();
  return options;
}

void Compare(const TunnelSurveyOptions& survey, MonteCarloOptions options,
             const ResultFolder& folder) {
  TunnelSurveyOptions forward_only = survey;
  forward_only.odometer_form = Odometer::Form::kForward;
  const std::vector<MonteCarloCase> cases = {
      CaseOf(survey, "",
             {Method::kEkf, Method::kTwoFilter, Method::kTwoFilterConventional,
              Method::kTwoFilterEuler, Method::kRts, Method::kIterated,
              Method::kBatch}),
      CaseOf(forward_only, "_forward_odometer",
             {Method::kEkf, Method::kTwoFilter, Method::kIterated,
              Method::kBatch})};
  options.leg_ends = ReferenceTimes(survey.reference_spacing);
  const MonteCarloResult result = RunMonteCarlo(cases, options);
  WriteFileAtomically(
      folder.Path(kJsonName),
      MonteCarloJson({kTunnelSurveyName, FLAGS_path, FLAGS_white_noise,
                      options.runs, options.first_seed},
                     result));
  for (const MethodStatistics& method : result.methods) {
    WriteFileAtomically(folder.Path(method.name + ".csv"),
                        MonteCarloCsv(method));
  }
  std::cout << "tunnel_survey, path " << FLAGS_path << ", noise "
            << FLAGS_white_noise << ", seeds " << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\n\n"
            << MonteCarloTable(result) << "\nLargest differences:\n"
            << AgreementText(result);
}

/// Largest standard deviation of any axis at any time, per spacing and noise.
void Sweep(TunnelSurveyOptions survey, const MonteCarloOptions& options,
           Progress* progress, const ResultFolder& folder) {
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
      const MonteCarloResult result = RunMonteCarlo(
          {CaseOf(survey, "", {Method::kTwoFilter, Method::kBatch})}, options);
      std::string cell;
      for (const MethodStatistics& m : result.methods) {
        cell +=
            Format("%s%.3f", cell.empty() ? "" : "  ", m.max_std.maxCoeff());
        csv += Format("%g,%g,%s,%.6g,%.6g,%.6g,%.6g\n", spacing, sigma,
                      m.name.c_str(), m.max_std.x(), m.max_std.y(),
                      m.max_std.z(), m.anees);
      }
      row.push_back(cell);
      progress->Update("sweep", ++cells_done / kCells);
    }
    table.AddRow(row);
  }
  WriteFileAtomically(folder.Path("sweep.csv"), csv);
  progress->Clear();
  std::cout << "tunnel_survey, path " << FLAGS_path << ", noise "
            << FLAGS_white_noise << ", " << options.runs
            << " runs a cell: largest standard deviation of an axis [m]\nby "
               "distance of the reference points\n\n"
            << table.Render();
}

int Run(const std::vector<std::string>& arguments) {
  if (arguments[0] != kTunnelSurveyName) {
    throw UsageError("'montecarlo' knows no scenario '" + arguments[0] +
                     "'; there is tunnel_survey");
  }
  if (FLAGS_out.empty()) {
    throw UsageError(
        "'montecarlo' needs --out=DIR, the folder for the results");
  }
  const TunnelSurveyOptions survey = ReadTunnelFlags();
  MonteCarloOptions options = ReadOptions();
  CatchInterrupts();
  ResultFolder folder(FLAGS_out, FLAGS_force,
                      FLAGS_sweep ? "sweep.csv" : kJsonName);
  Progress progress(Progress::ModeFromName(FLAGS_progress));
  if (FLAGS_sweep) {
    Sweep(survey, options, &progress, folder);
  } else {
    options.progress = [&](int done) {
      progress.Update("runs", static_cast<double>(done) / options.runs);
      if (done == options.runs) progress.Clear();
    };
    Compare(survey, options, folder);
  }
  folder.Commit();
  return kUsable;
}

}  // namespace

Command MonteCarloCommand() {
  return {
      .name = "montecarlo",
      .summary = "compare the methods over many seeds of a scenario",
      .arguments = "SCENARIO",
      .help = kHelp,
      .flags = {{"out", "DIR", "folder for the results (required)"},
                {"force", "", "replace the results of an earlier call in DIR"},
                {"runs", "N", "number of seeds (100)"},
                {"seed", "N", "the first seed; the others follow it (1)"},
                {"threads", "N", "0: as many as there are cores (0)"},
                {"path", "NAME", "winding, serpentine or straight (winding)"},
                {"white_noise", "READING",
                 "of the IMU's white noise: sample, the standard deviation\n"
                 "of each sample, or density, per sqrt(Hz) (sample)"},
                {"sweep", "",
                 "table over the distance of reference points and the\n"
                 "odometer noise"},
                {"progress", "MODE", "on stderr: auto, json or none (auto)"}},
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
