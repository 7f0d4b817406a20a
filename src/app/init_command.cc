#include <filesystem>
#include <iostream>
#include <mutex>
#include <system_error>

#include "app/abandoned.h"
#include "app/command.h"
#include "app/file_place.h"
#include "app/flags.h"
#include "app/interrupt.h"
#include "io/config/init_config.h"
#include "io/read/paths.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Looks at the files in FOLDER and prints a commented configuration for what it
recognises, to be completed and given to 'check' and 'run'. Ends with 1 if it
recognises no IMU.
)";

/// Writes the configuration to --out. A signal ends the process when that is
/// done, so that no half of a file is left.
void Write(const std::string& config) {
  std::mutex writing;
  bool written = false;
  const StopWatch watch([&] {
    // For good: who waits for it from now on waits for the end of the process.
    writing.lock();
    return "interrupted; " +
           (written ? FLAGS_out + " is in place" : "nothing is left");
  });
  const std::lock_guard lock(writing);
  AtomicFile file(FLAGS_out);
  file.Write(config);
  file.Commit(FLAGS_force);
  written = true;
}

/// A killed call leaves a whole configuration or an empty file.
std::string Disowned(const std::filesystem::path& path) {
  std::error_code refused;
  if (!IsFile(path)) return "is no file";
  return std::filesystem::file_size(path, refused) == 0 || IsInitConfig(path)
             ? ""
             : "was not written by 'init', or changed since";
}

int Run(const std::vector<std::string>& arguments) {
  if (!FLAGS_out.empty()) CheckFilePlace(FLAGS_out, {"'init'", IsInitConfig});
  const InitDraft draft = InitConfig(arguments[0]);
  const ExitStatus status = draft.has_imu ? kUsable : kUnusable;
  if (!draft.has_imu) {
    std::cerr << "hindsight: " << arguments[0]
              << ": no IMU was recognised; name its file and columns under "
                 "`imu` of the draft\n";
  }
  if (FLAGS_out.empty()) {
    std::cout << draft.text;
    return status;
  }
  TreatAbandoned(FLAGS_out, FLAGS_clean, Disowned);
  Write(draft.text);
  if (const std::error_code error =
          SyncFolder(std::filesystem::absolute(FLAGS_out).parent_path())) {
    throw OutputError(
        "output file " + FLAGS_out +
        " is in place, but may be lost with the power: " + error.message());
  }
  std::cout << "wrote " << FLAGS_out << "\nlook at the recording with: "
            << "hindsight check " << FLAGS_out << "\n";
  return status;
}

}  // namespace

Command InitCommand() {
  return {
      .name = "init",
      .summary = "draft a configuration for a folder of recorded files",
      .arguments = "FOLDER",
      .help = kHelp,
      .flags = {{"out", "FILE", "write the configuration there"},
                {"force", "", "replace FILE if 'init' wrote it"},
                {"clean", "", "remove what killed calls left beside FILE"}},
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
