#include <filesystem>
#include <iostream>

#include "app/command.h"
#include "app/draft_file.h"
#include "app/draft_refinement.h"
#include "app/file_place.h"
#include "app/flags.h"
#include "app/observer_flags.h"
#include "app/progress.h"
#include "app/run.h"
#include "app/run_request.h"
#include "base/error.h"
#include "io/config/init_config.h"
#include "io/read/paths.h"
#include "problems/method.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Reconstructs the recording that CONFIG describes by every method asked for
and writes into the folder of --out:
  METHOD.csv            time, position, velocity, attitude, their standard
                        deviations and covariances, biases
  METHOD.at.csv         the same at the times of --at
  METHOD.truth.csv      the same at the times of the truth and the point that it
                        speaks of: what the errors are taken of, here and by
                        'evaluate'
  METHOD.motion.csv     body rates and specific force, biases removed
  METHOD.constants.csv  constants against time: of ekf as it learned them, of
                        two_filter as the backward filter did
  METHOD.errors.csv     errors against a truth, with their standard deviations
  METHOD.npz, .motion.npz  with --export=npz, in place of METHOD.csv and
                        METHOD.motion.csv: their columns as NumPy arrays
  METHOD.tum, .kml, .nav  what --export asks for
  METHOD.nav.txt        with --inject: the errors injected, for .nav, which knows
                        no comments
  METHOD.modes.csv      probabilities of the modes of imm, imm_smoother and
                        robust_batch
  residuals.csv         every measurement's residual, sigma, weight and fate
  fixes.csv             every position measured: what the receiver said of it,
                        and what became of it
  summary.json          figures of every method, and of the inputs their sizes
                        and SHA-256, for programs
  config.resolved.yaml  the configuration as used, in SI units
  report.html           with --report: one page that shows all of it
  manifest.json         the files of this folder
Comments of every .csv, lines that begin with '#', say what t = 0 is: GPS week
and second, and UTC. Between the nodes a solution is integrated through the IMU:
of a forward method (ekf, gated_ekf, hinf, modified_hinf, imm) from the node
before, knowing nothing later; of a smoother what that misses of the node after
is spread over the interval.
The folder appears when all is done and on the medium. What is in the way by
then stays, and the results are beside it as DIR.1. After Ctrl-C, SIGTERM,
SIGHUP, an error or on a full disk the methods that were done stay, without
residuals.csv, and summary.json says complete: false; they never replace
complete results. If no method was done, or summary.json cannot be written,
nothing stays. A second Ctrl-C ends at once. A killed run leaves a folder
.DIR.partial-*, which the next one names. On a file system that cannot exchange
two names in one step, --force renames twice, and a kill in between leaves both
folders so.
Where the data allow several clocks (time_offset: unknown, or estimated with a
sigma of 0.1 s or more) each is solved to its end; the likeliest is taken, and
what the others differ in is told with their probability.
Every result is usable, doubtful or not usable, by one set of rules that looks
at no truth; summary.json holds the evidence, and the report what to try. The
last line and the exit status are those of the best method: the best grade; of
equal ones the least evidence against it; then the order of the lists below.
What a truth contradicts stands in a line of its own.
A folder in place of CONFIG is looked at as 'init' does; its configuration is
written to DIR.yaml beside the results. Of what it takes for granted it tells,
and the results are at best doubtful until --yes says that it is so.
)";

constexpr const char* kAttitudeHelp =
    R"(These write attitude (angles and quaternion), gyro bias, the accelerometer's
sigma in force and the verdict on the magnetometer, at the stamps of the IMU.
)";

std::string Help() {
  return std::string(kHelp) + "\nMethods:\n" + MethodHelp(false) +
         "Of attitude alone, from IMU and magnetometer, without any "
         "position:\n" +
         MethodHelp(true) + kAttitudeHelp;
}

/// The configuration of the only recording in a folder, beside the results.
std::string DraftBeside(const std::string& folder) {
  if (FLAGS_out.empty()) {
    throw UsageError("'run' needs --out=DIR, the folder for the results");
  }
  const std::string config =
      std::filesystem::path(FLAGS_out + "/").parent_path().string() + ".yaml";
  CheckFilePlace(config, {"'init'", IsInitConfig});
  RequireRoomFor(config);
  const std::vector<RecordingDraft> drafts = [&] {
    Progress progress(AskedProgress());
    return DraftFolder(folder, &progress);
  }();
  if (drafts.size() > 1) {
    std::string names;
    for (const RecordingDraft& draft : drafts) {
      names += (names.empty() ? "" : ", ") + draft.name;
    }
    throw InputError(folder, 0,
                     "holds " + std::to_string(drafts.size()) +
                         " recordings (" + names +
                         "); expected the folder of one, or a configuration "
                         "that 'init' writes of each");
  }
  const RecordingDraft& draft = drafts.front();
  WriteDraft(config, DraftText(draft));
  if (IsAttitudeAlone(draft) && !IsGiven("methods")) {
    FLAGS_methods = MethodNames(true);
  }
  std::cout << "wrote " << config << "\n";
  PrintLeftOut(draft);
  for (const std::string& assumption : draft.assumptions) {
    std::cout << "taken for granted: " << assumption << "\n";
  }
  return config;
}

int Run(const std::vector<std::string>& arguments) {
  const bool folder = IsFolder(arguments[0]);
  const std::string config = folder ? DraftBeside(arguments[0]) : arguments[0];
  try {
    return Reconstruct(ReadRunRequest(config));
  } catch (const OnlyAttitude&) {
    if (IsGiven("methods")) throw;
  }
  FLAGS_methods = MethodNames(true);
  std::cout << "no stream tells where the IMU is: attitude alone, by "
            << FLAGS_methods << "\n";
  return Reconstruct(ReadRunRequest(config));
}

}  // namespace

Command RunCommand() {
  return {
      .name = "run",
      .summary = "reconstruct a trajectory by several methods",
      .arguments = "CONFIG|FOLDER",
      .help = Help(),
      .flags = WithObserverFlags(
          {{"out", "DIR", "folder for the results (required)"},
           {"force", "",
            "replace DIR if it holds nothing but results of an\n"
            "earlier run, by its manifest.json"},
           {"clean", "", "remove what killed runs left beside DIR"},
           {"methods", "LIST",
            "methods of one kind, as 'run --help' lists them\n"
            "(ekf,rts,iterated,batch)"},
           {"ahrs_rule", "NAME",
            "how the accelerometer is trusted: fixed, gate,\n"
            "held_gate, adaptive or smnc (as the configuration says)"},
           {"from", "T", "begin at T seconds since the data set's epoch"},
           {"to", "T", "end at T seconds"},
           {"max_time", "S",
            "longest time that robust_batch may search for errors of\n"
            "sensors, by the clock; it then ends with the best so far,\n"
            "which is doubtful (as long as it takes)"},
           {"rate", "HZ", "rate of the output (at the estimator's nodes)"},
           {"at", "FILE",
            "also poses with covariance at the times in FILE,\n"
            "seconds, one a line"},
           {"point", "X,Y,Z",
            "output this point of the vehicle: metres\n"
            "forward, right, down of the IMU (0,0,0)"},
           {"withhold", "RULE",
            "keep a sensor from the estimators now and then and report\n"
            "the errors over each outage, in place of the\n"
            "configuration's rules: position:every=120s,length=30s\n"
            "with ,from=90s for the first outage's start, since the\n"
            "stream's first fix (every after the first that the IMU\n"
            "covers); sensor is a stream or a type of streams;\n"
            "several rules: separate by ; or repeat the flag"},
           {"without", "NAMES", "leave out these aiding streams of CONFIG"},
           {"constants", "RESULT",
            "start from the constants of an earlier result of 'run' or\n"
            "'combine', in place of constants.from of CONFIG"},
           {"omit", "SPAN",
            "leave out what a sensor says in a span, neither used nor\n"
            "judged: gnss:100..130 in seconds since the data set's\n"
            "epoch; several: separate by ; or repeat"},
           {"yes", "", "what the configuration takes for granted is so"},
           {"inject", "ERROR",
            "add an error on purpose, marked in every output:\n"
            "position:step=12m,from=140s,to=150s; or pulse, ramp,\n"
            "spikes (share=10%) or multipath (tau=20s) in place of\n"
            "step, with axes=ne; a size in m, of a velocity in m/s;\n"
            "withheld measurements stay as they are; several:\n"
            "separate by ; or repeat"},
           {"seed", "N", "of --inject's spikes and multipath (1)"},
           {"export", "LIST",
            "some of csv,npz,tum,kml,nav (csv); npz: arrays of all columns,\n"
            "exact, written in place of METHOD.csv, which csv,npz keeps"},
           {"report", "",
            "write report.html as well, one page that shows the results\n"
            "(see 'hindsight report')"},
           {"threads", "N",
            "that work at once, 0: as many as there are cores; the\n"
            "results do not depend on it (0)"},
           {"progress", "MODE",
            "on stderr: auto (a line on a terminal), json (an object\n"
            "a line) or none (auto)"},
           {"data_root", "DIR",
            "where a relative folder of CONFIG is looked for, if\n"
            "not beside it"}}),
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
