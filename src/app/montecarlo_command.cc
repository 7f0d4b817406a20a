#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "app/asked_methods.h"
#include "app/command.h"
#include "app/flags.h"
#include "app/observer_flags.h"
#include "app/progress.h"
#include "app/result_folder.h"
#include "app/studies.h"
#include "app/study_cases.h"
#include "app/study_report.h"
#include "app/study_shard.h"
#include "base/parallel.h"
#include "io/config/scenario_config.h"
#include "io/read/paths.h"
#include "problems/navigation_trial.h"

namespace hindsight {
namespace {

constexpr const char* kHelpBefore =
    R"(Repeats a scenario with other seeds and compares what each method makes of it:
standard deviation and mean of the errors over the runs, consistency (ANEES with
its bounds, NIS), grades, estimated constants, processor time. SCENARIOs are any
that 'simulate' takes, names (simulate --list) or YAML files, run by --methods
and judged once a second; or one of these comparisons, with its own methods:
)";

constexpr const char* kHelpAfter = R"(Writes into the folder of --out:
  montecarlo.json  the figures, a row a case and method, by table: cells, and
                   where there are constants and agreement (of two methods)
  cells.csv, constants.csv, agreement.csv
                   the same tables, without processor times
  runs.csv         a row a case, method and seed: grade and values of the run
  curves.csv       figures against time
  manifest.json    the files of this folder
  report.html      with --report: tables, figures against time with their bounds,
                   and against the numbers of --sweep
  shard.cbor       with --shard in place of all but the manifest: what 'merge'
                   puts together
The folder appears when all is done, as that of 'run' does. After Ctrl-C,
SIGTERM, SIGHUP or on a full disk montecarlo.json says complete: false and holds
the first runs as far as they are finished, as --runs of that number makes them
(two at least, or nothing stays), and of several cases those that are finished.
The figures do not depend on the number of threads. A recording that
is refused counts as a failed run and is named.
)";

/// Standard deviations are over two runs or more.
constexpr int kLeastRuns = 2;

/// What takes --methods and --set, in words.
constexpr char kOtherScenarios[] = "scenarios that are no comparison";

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string Help() {
  std::string text = kHelpBefore;
  for (const NamedStudy& study : NamedStudies()) {
    std::string name = study.name;
    name.resize(21, ' ');
    for (const std::string& line : Split(study.help, '\n')) {
      text += "  " + name + line + "\n";
      name.assign(name.size(), ' ');
    }
  }
  return text + kHelpAfter;
}

/// "gps_jumps", "tunnel_survey, uuv_survey"; "" of a flag that all take.
std::string ScenariosWith(const std::string& flag) {
  const bool is_of_others =
      flag == "set" || flag == "methods" || flag == "sweep";
  std::vector<std::string> names;
  if (is_of_others) names.emplace_back(kOtherScenarios);
  for (const NamedStudy& study : NamedStudies()) {
    if (Has(study.flags, flag)) names.push_back(study.name);
  }
  return Joined(names, ", ");
}

std::vector<FlagUse> Flags() {
  std::vector<FlagUse> flags = WithObserverFlags(
      {{"out", "DIR", "folder for the results (required)"},
       {"force", "",
        "replace DIR if it holds nothing but results of an\n"
        "earlier call, by its manifest.json"},
       {"clean", "", "remove what killed calls left beside DIR"},
       {"runs", "N",
        "number of seeds, at least 2 (100; 300 of in_flight_alignment)"},
       {"seed", "N", "the first seed; the others follow it (1)"},
       {"threads", "N", "0: as many as there are cores (0)"},
       {"methods", "LIST",
        "as of 'run' (ekf,rts,iterated,batch); in_flight_alignment\n"
        "takes the observers ekf, hinf, modified_hinf (all), with\n"
        "them --error takes a list (all three), --gamma too (1,5),\n"
        "and modified_hinf runs with both --alpha-blocks"},
       {"set", "KEY=VALUE",
        "change a key of the scenario, aiding.gnss.sigma='2 m', or\n"
        "choose, errors=spikes; a case each of VALUE|VALUE; several\n"
        "times"},
       {"sweep", "KEY=V1,V2,... UNIT",
        "a case each of several numbers of a key, several times:\n"
        "imu.noise.gyro='0.05,0.1,0.5 deg/sqrt(h)'"},
       {"shard", "I/N",
        "only the I-th of N parts of the runs, for 'hindsight merge'"},
       {"report", "", "write the page report.html as well"},
       {"faults", "FILE",
        "vehicles and faults of grades, as data/faults/grades.yaml"},
       {"progress", "MODE", "on stderr: auto, json or none (auto)"}});
  for (FlagUse& flag : flags) {
    const std::string names = ScenariosWith(flag.name);
    if (!names.empty()) flag.help += "; of " + names;
  }
  return flags;
}

/// Throws UsageError naming the first flag that is given although it means
/// nothing to the scenario, and what it goes with.
void CheckFlags(const std::string& scenario,
                const std::vector<std::string>& own) {
  for (const FlagUse& flag : Flags()) {
    const std::string names = ScenariosWith(flag.name);
    if (!IsGiven(flag.name) || names.empty() || Has(own, flag.name)) continue;
    throw UsageError("--" + Dashed(flag.name) + " means nothing to " +
                     scenario + "; it goes with " + names);
  }
}

MonteCarloOptions ReadOptions(std::uint64_t default_runs) {
  const std::uint64_t runs = IsGiven("runs") ? FLAGS_runs : default_runs;
  if (runs < kLeastRuns || runs > 1000000) {
    throw UsageError("--runs=" + std::to_string(runs) +
                     ": expected 2 to 1000000");
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
  // Runs go on side by side, so that there is nothing to share within one.
  options.threads = ReadThreads();
  SetThreadCount(1);
  return options;
}

void RunAndReport(const Study& study, MonteCarloOptions options,
                  Progress* progress, ResultFolder* folder) {
  options.progress = [&](double done) { progress->Update("runs", done); };
  const auto work = std::make_shared<StudyRun>(study, options, 0, options.runs);
  folder->KeepAtEnd([study, options, work]() -> std::vector<OutputFile> {
    StudyResult result = work->SoFar();
    if (result.runs < kLeastRuns || result.refused()) return {};
    result.complete = false;
    return StudyFiles(study, result, options);
  });
  work->Do();
  const StudyResult result = work->SoFar();
  result.RequireAnswer();
  progress->Clear();
  ReportStudy(study, result, options, folder);
}

/// One comparison by its name, or any scenarios that `simulate` knows.
NamedStudy Find(const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const NamedStudy& study : NamedStudies()) {
    names.push_back(study.name);
    if (arguments == std::vector{study.name}) return study;
  }
  for (const std::string& name : arguments) {
    if (Has(ScenarioNames(), name) || PathExists(name)) continue;
    throw UsageError("'montecarlo' knows no scenario and finds no file '" +
                     name + "'" + Suggestion(name, names) + "; there is " +
                     Joined(names, ", "));
  }
  const auto study = [arguments] {
    return StudyOf(
        {arguments,
         {},
         NavigationTrialOf({.methods = ReadTrajectoryMethods(FLAGS_methods),
                            .judged_every = 1.0}),
         NavigationTables(),
         true});
  };
  return {arguments.front(), "", study, {"methods", "set", "sweep"}};
}

int Run(const std::vector<std::string>& arguments) {
  const NamedStudy choice = Find(arguments);
  CheckFlags(choice.name, choice.flags);
  if (FLAGS_out.empty()) {
    throw UsageError(
        "'montecarlo' needs --out=DIR, the folder for the results");
  }
  const MonteCarloOptions options = ReadOptions(choice.default_runs);
  Progress progress(Progress::ModeFromName(FLAGS_progress));
  Study study = choice.make();
  if (study.name.empty()) study.name = choice.name;
  const std::optional<ShardNumber> shard = ReadShardNumber(options.runs);
  return WithResultFolder(
      {FLAGS_out, FLAGS_force, FLAGS_clean}, [&] { return FilesOf(arguments); },
      [&](ResultFolder* folder) {
        if (shard) {
          RunShardInto(
              {SharedCall(arguments, choice, study, options, shard->of),
               shard->number,
               {shard->BeginOf(options.runs), shard->EndOf(options.runs), {}}},
              study, options, &progress, folder);
        } else {
          RunAndReport(study, options, &progress, folder);
        }
        progress.Finish();
        return kUsable;
      });
}

}  // namespace

Command MonteCarloCommand() {
  return {
      .name = "montecarlo",
      .summary = "compare the methods over many seeds of a scenario",
      .arguments = "SCENARIO [SCENARIO2 ...]",
      .help = Help(),
      .flags = Flags(),
      .min_arguments = 1,
      .max_arguments = 1000,
      .run = Run,
  };
}

}  // namespace hindsight
