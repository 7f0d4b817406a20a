#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/finished_runs.h"
#include "app/flags.h"
#include "app/list_flags.h"
#include "app/montecarlo_scenarios.h"
#include "base/text.h"
#include "base/units.h"
#include "io/table.h"
#include "problems/alignment_trial.h"
#include "simulation/in_flight_alignment.h"

namespace hindsight {
namespace {

constexpr double kAfterManoeuvre = 10.0;  // [s]
constexpr AlignmentTrialOptions kTrial = {
    .t_early = kFirstManoeuvre + kAfterManoeuvre,
    .diverged_tilt = 2.0 * kDegree,
    .diverged_heading = 10.0 * kDegree,
    .last = 20.0};

std::vector<AlignmentRecording> Recordings() {
  std::vector<AlignmentRecording> recordings;
  for (const double rate : ReadPositiveNumbers("rates", FLAGS_rates)) {
    const auto perfect = std::make_shared<const PerfectRecording>(
        InFlightAlignment({.velocity_rate_hz = rate}));
    recordings.push_back({Format("%g Hz", rate), [perfect](std::uint64_t seed) {
                            Dataset dataset = perfect->Realize(seed);
                            MountAnywhere(seed, &dataset);
                            dataset.initial.alignment =
                                AlignmentKind::kVelocity;
                            return dataset;
                          }});
  }
  return recordings;
}

std::string AngleCell(const AlignmentStatistics::Angle& angle) {
  return Format("%.4f %.4f %.4f %.3f", angle.rms / kDegree,
                angle.worst / kDegree, angle.sigma / kDegree,
                angle.largest / kDegree);
}

nlohmann::ordered_json AngleJson(const AlignmentStatistics::Angle& angle) {
  return {{"rms_deg", angle.rms / kDegree},
          {"worst_epoch_rms_deg", angle.worst / kDegree},
          {"sigma_deg", angle.sigma / kDegree},
          {"max_deg", angle.largest / kDegree}};
}

std::string Table(const std::vector<AlignmentStatistics>& all) {
  ReportTable table({"velocity", "method", "failed",
                     "tilt [deg]\nrms  worst  sigma  max",
                     "heading [deg]\nrms  worst  sigma  max", "ANEES\n(3)",
                     "bounds", "outside\n[%]", "s/run"});
  for (const AlignmentStatistics& s : all) {
    std::vector<std::string> row = {s.recording, s.name,
                                    Format("%d of %d", s.failed, s.runs)};
    if (s.answered > 0) {
      row.insert(row.end(), {AngleCell(s.tilt), AngleCell(s.heading),
                             Format("%.2f", s.anees),
                             Format("%.2f-%.2f", s.anees_lower, s.anees_upper),
                             Format("%.1f", 100.0 * s.anees_outside)});
    }
    row.resize(8);
    row.push_back(Format("%.3f", s.seconds));
    table.AddRow(std::move(row));
  }
  return table.Render();
}

std::string JsonText(const std::vector<AlignmentStatistics>& all,
                     const MonteCarloOptions& options, bool complete) {
  nlohmann::ordered_json json = {{"scenario", kVelocityAlignmentName},
                                 {"complete", complete},
                                 {"runs", RunsOf(all)},
                                 {"runs_asked", options.runs},
                                 {"first_seed", options.first_seed}};
  for (const AlignmentStatistics& s : all) {
    nlohmann::ordered_json& method = json["methods"][s.recording][s.name];
    method = {{"failed", s.failed}, {"seconds_per_run", s.seconds}};
    if (s.answered == 0) continue;
    method["tilt"] = AngleJson(s.tilt);
    method["heading"] = AngleJson(s.heading);
    method["anees"] = s.anees;
    method["anees_bounds"] = {s.anees_lower, s.anees_upper};
    method["anees_outside"] = s.anees_outside;
  }
  return json.dump(2) + "\n";
}

}  // namespace

void RunVelocityAlignment(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder) {
  options.progress = RunProgress(options.runs, progress);
  const auto files = [options](const std::vector<AlignmentStatistics>& all,
                               bool complete) -> std::vector<OutputFile> {
    return {{kMonteCarloJson, JsonText(all, options, complete)}};
  };
  const std::vector<AlignmentStatistics> all = TryAlignment(
      Recordings(), kTrial, options,
      KeepFinishedRuns<std::vector<AlignmentStatistics>>(folder, files));
  progress->Clear();
  std::cout << "in_flight_alignment from no start value, the IMU mounted at "
               "any attitude, seeds "
            << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\nvelocity_alignment: data up to " << kTrial.t_early
            << " s, errors there; velocity_alignment_batch: over the whole "
               "interval\nrms: over runs and epochs; worst: over the runs, at "
               "the worst epoch; sigma: stated\n\n"
            << Table(all);
  CommitFiles(files(all, true), folder);
}

}  // namespace hindsight
