#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/montecarlo_scenarios.h"
#include "app/text.h"
#include "base/units.h"
#include "io/atomic_file.h"
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
  for (const double rate : {10.0, 1.0}) {
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

std::string Table(const std::vector<AlignmentStatistics>& all) {
  ReportTable table({"velocity", "method", "failed", "tilt rms\n[deg]",
                     "heading rms\n[deg]", "tilt max\n[deg]",
                     "heading max\n[deg]", "ANEES\n(3)", "bounds",
                     "outside\n[%]", "s/run"});
  for (const AlignmentStatistics& s : all) {
    table.AddRow(
        {s.recording, s.name, Format("%d of %d", s.failed, s.runs),
         Format("%.4f", s.tilt_rms / kDegree),
         Format("%.4f", s.heading_rms / kDegree),
         Format("%.4f", s.tilt_largest / kDegree),
         Format("%.4f", s.heading_largest / kDegree), Format("%.2f", s.anees),
         Format("%.2f-%.2f", s.anees_lower, s.anees_upper),
         Format("%.1f", 100.0 * s.anees_outside), Format("%.3f", s.seconds)});
  }
  return table.Render();
}

std::string JsonText(const std::vector<AlignmentStatistics>& all,
                     const MonteCarloOptions& options) {
  nlohmann::ordered_json json = {{"scenario", "velocity_alignment"},
                                 {"runs", options.runs},
                                 {"first_seed", options.first_seed}};
  for (const AlignmentStatistics& s : all) {
    json["methods"][s.recording][s.name] = {
        {"failed", s.failed},
        {"tilt_rms_deg", s.tilt_rms / kDegree},
        {"heading_rms_deg", s.heading_rms / kDegree},
        {"tilt_max_deg", s.tilt_largest / kDegree},
        {"heading_max_deg", s.heading_largest / kDegree},
        {"anees", s.anees},
        {"anees_bounds", {s.anees_lower, s.anees_upper}},
        {"anees_outside", s.anees_outside},
        {"seconds_per_run", s.seconds}};
  }
  return json.dump(2) + "\n";
}

}  // namespace

void RunVelocityAlignment(MonteCarloOptions options, Progress* progress,
                          ResultFolder* folder) {
  options.progress = RunProgress(options.runs, progress);
  const std::vector<AlignmentStatistics> all =
      TryAlignment(Recordings(), kTrial, options);
  WriteFileAtomically(folder->Path(kMonteCarloJson), JsonText(all, options));
  progress->Clear();
  std::cout << "in_flight_alignment from no start value, the IMU mounted at "
               "any attitude, seeds "
            << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint64_t>(options.runs - 1)
            << "\nvelocity_alignment: data up to " << kTrial.t_early
            << " s, errors there; velocity_alignment_batch: largest error over "
               "the whole interval\n\n"
            << Table(all);
}

}  // namespace hindsight
