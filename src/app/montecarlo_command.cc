#include <algorithm>
#include <limits>
#include <thread>

#include "app/command.h"
#include "app/flags.h"
#include "app/montecarlo_scenarios.h"
#include "app/observer_flags.h"
#include "app/progress.h"
#include "app/result_folder.h"
#include "evaluation/chi_square.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Repeats a built-in scenario with other seeds and compares what each method
makes of it: standard deviation of the position over the runs (largest over
time, north, east, down, all and by leg), heading, consistency (ANEES of the
whole state, NIS), processor time. SCENARIO is one of
  tunnel_survey        an odometer survey of 8 km
  calibration          ten minutes on which lever arms, time offsets, scale
                       factors and the mounting are all unknown and estimated,
                       each judged by its errors over its sigmas
  in_flight_alignment  forward observers from bad initial attitudes, Riccati
                       rule x definition of the error x start: shares that
                       diverge or escape, time to settle, final errors, Lyapunov
                       figures
  velocity_alignment   aligns the same flight from no start value, the IMU
                       mounted at any attitude, and then solves it as a batch
  gps_jumps            filters and batches under errors of the positions
  uuv_survey           a dive with INS, DVL and depth: lawn-mower, straight leg
                       and lawn-mower that ends near its start, each without
                       and with a final fix and with a gap of the DVL
  uuv_calibration      figures of eight at the surface with GNSS: scale,
                       boresight and lever arm of the DVL, judged as above
  uuv_search           the fusions of Lee and Yoon (2011) as printed, 16
                       readings: 2-D and 3-D distance error with histograms
Writes into the folder of --out:
  montecarlo.json   the figures of all methods and how far they agree
  cells.csv         of in_flight_alignment: a row a cell
  gps_jumps.csv     of gps_jumps: one line for profile, sigma, rate and method
  PROFILE_SIGMAm_RATEhz_METHOD.csv  root mean square errors of position and
                    velocity, ANEES and mode probabilities against time
  METHOD.csv        of tunnel_survey and both calibrations: standard deviations
                    and ANEES against time
  sweep.csv         with --sweep, its figures: largest standard deviation
                    for reference points every 0.25 to 8 km and odometer noise
                    of 5 to 100 mm/s
  manifest.json     the files of this folder
The folder appears when all is done, as that of 'run' does. After Ctrl-C,
SIGTERM, SIGHUP or on a full disk montecarlo.json says complete: false and holds
the first runs as far as they are finished, as --runs of that number makes them
(two at least, or nothing stays); of gps_jumps, uuv_survey, uuv_search,
vibration_attitude and --sweep the settings that are finished.
The figures do not depend on the number of threads.
SCENARIO vibration_attitude compares the accelerometer rules of attitude-only
estimation under acceleration and vibration, for disturbances along north, one
and all body axes, and up: montecarlo.json holds RMS and maximum of the attitude
by axis and interval, gyro bias, and the shares inside 3 sigma.
)";

MonteCarloOptions ReadOptions(std::uint64_t default_runs) {
  const std::uint64_t runs = IsGiven("runs") ? FLAGS_runs : default_runs;
  if (runs < 2 || runs > 1000000) {
    throw UsageError("--runs=" + std::to_string(runs) +
                     ": expected 2 to 1000000");
  }
  constexpr std::uint64_t kMostThreads = 1024;
  if (FLAGS_threads > kMostThreads) {
    throw UsageError("--threads=" + std::to_string(FLAGS_threads) +
                     ": expected 0 to 1024");
  }
  constexpr std::uint64_t kLastSeed = std::numeric_limits<std::uint64_t>::max();
  if (FLAGS_seed > kLastSeed - (runs - 1)) {
    throw UsageError("--seed=" + std::to_string(FLAGS_seed) + ": the last of " +
                     std::to_string(runs) + " seeds would be beyond " +
                     std::to_string(kLastSeed));
  }
  MonteCarloOptions options;
  options.runs = static_cast<int>(runs);
  options.first_seed = FLAGS_seed;
  options.threads =
      FLAGS_threads > 0
          ? static_cast<int>(FLAGS_threads)
          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  options.anees_bounds = [](int runs, int dim) {
    const Interval bounds = AneesBounds(runs, dim, 0.95);
    return std::pair(bounds.lower, bounds.upper);
  };
  return options;
}

std::vector<FlagUse> Flags() {
  return WithScenarioNames(WithObserverFlags(
      {{"out", "DIR", "folder for the results (required)"},
       {"force", "",
        "replace DIR if it holds nothing but results of an\n"
        "earlier call, by its manifest.json"},
       {"clean", "", "remove what killed calls left beside DIR"},
       {"runs", "N",
        "number of seeds, at least 2 (100; 300 of in_flight_alignment)"},
       {"seed", "N", "the first seed; the others follow it (1)"},
       {"threads", "N",
        "0: as many as there are cores; vibration_attitude and\n"
        "uuv_search use one (0)"},
       {"path", "NAME",
        "winding, serpentine or straight (winding), of uuv_survey\n"
        "lawnmower, straight or returning (all)"},
       {"white_noise", "READING",
        "of the IMU's white noise: sample, the standard deviation\n"
        "of each sample, or density, per sqrt(Hz) (sample)"},
       {"sweep", "",
        "table over the distance of reference points and the\n"
        "odometer noise"},
       {"rates", "LIST", "rates of the velocity [Hz] (10,1)"},
       {"tilt", "LIST", "tilts of the start [deg] (10,30)"},
       {"heading", "LIST", "heading errors of the start [deg] (30,60,120,175)"},
       {"rules", "LIST",
        "some of ekf,hinf,modified_hinf (all); with them --error\n"
        "takes a list (all three), --gamma too (1,5), and\n"
        "modified_hinf runs with both --alpha-blocks"},
       {"errors", "LIST",
        "some of none,pulses,spikes,steps,ramp,multipath (all)"},
       {"gps_sigma", "LIST", "of the positions, 0.001 to 1000 [m] (1)"},
       {"gps_rate", "LIST",
        "of the positions: 100 or 1 over a whole number [Hz] (1)"},
       {"reading", "WORDS",
        "sum or position, diagonal or acceleration, white or\n"
        "accumulating, by_noise or alike, with commas (all)"},
       {"progress", "MODE", "on stderr: auto, json or none (auto)"}}));
}

int Run(const std::vector<std::string>& arguments) {
  const MonteCarloScenario& scenario = FindMonteCarloScenario(arguments[0]);
  CheckScenarioFlags(scenario, Flags());
  if (FLAGS_out.empty()) {
    throw UsageError(
        "'montecarlo' needs --out=DIR, the folder for the results");
  }
  const MonteCarloOptions options = ReadOptions(scenario.default_runs);
  Progress progress(Progress::ModeFromName(FLAGS_progress));
  return WithResultFolder(
      {FLAGS_out, FLAGS_force, FLAGS_clean},
      [] { return ResultFolder::Paths{}; },
      [&](ResultFolder* folder) {
        scenario.run(options, &progress, folder);
        progress.Finish();
        return kUsable;
      });
}

}  // namespace

std::function<void(int)> RunProgress(int runs, Progress* progress) {
  return [runs, progress](int done) {
    progress->Update("runs", static_cast<double>(done) / runs);
    if (done == runs) progress->Clear();
  };
}

Command MonteCarloCommand() {
  return {
      .name = "montecarlo",
      .summary = "compare the methods over many seeds of a scenario",
      .arguments = "SCENARIO",
      .help = kHelp,
      .flags = Flags(),
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
