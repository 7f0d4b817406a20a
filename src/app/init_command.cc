#include <algorithm>
#include <filesystem>
#include <iostream>

#include "app/abandoned.h"
#include "app/command.h"
#include "app/draft_file.h"
#include "app/draft_refinement.h"
#include "app/error_line.h"
#include "app/file_place.h"
#include "app/flags.h"
#include "app/progress.h"
#include "app/shell_word.h"
#include "base/error.h"
#include "io/config/config.h"
#include "io/config/init_config.h"
#include "io/read/paths.h"
#include "io/write/unpublished.h"
#include "problems/method.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Looks at the files in FOLDER and below it, and prints a commented configuration
that 'check' and 'run' take as it stands. Streams are told by their formats, the
titles of their columns and the numbers themselves; axes, noise, clocks, and the
forward axis of a vehicle by how the readings go together. Every guess stands
there with its reason, and what matters of them under `unconfirmed`. A folder of
several recordings gives a configuration each, which --out=DIR takes. A file is a
truth only by its name. Without an IMU it ends with 2, as with a configuration
that does not load: it is written, and what to mend in it or in the recording is
said.
)";

/// A killed call leaves a whole configuration or an empty file.
std::string Disowned(const std::filesystem::path& path) {
  std::error_code refused;
  if (!IsFile(path)) return "is no file";
  return std::filesystem::file_size(path, refused) == 0 || IsInitConfig(path)
             ? ""
             : "was not written by 'init', or changed since";
}

/// Says why a draft that was written as `path` does not load, if so.
void TellProblem(const RecordingDraft& draft, const std::string& path) {
  if (draft.loads) return;
  try {
    LoadDataset(path, {.text = DraftText(draft)});
  } catch (const InputError& error) {
    PrintError(error.what());
  }
}

void WriteInto(const std::string& path, const RecordingDraft& draft) {
  CheckFilePlace(path, {"'init'", IsInitConfig});
  TreatAbandoned(path, FLAGS_clean, Disowned);
  WriteDraft(path, DraftText(draft));
  std::cout << "wrote " << path << "\n";
  if (IsAttitudeAlone(draft)) {
    std::string methods = MethodNames(true);
    std::erase(methods, ' ');
    std::cout << "no stream tells where the IMU is: attitude alone, by "
                 "hindsight run "
              << ShellWord(path) << " --methods=" << methods << " --out=DIR\n";
  }
  PrintLeftOut(draft);
  TellProblem(draft, path);
}

/// Files of a folder of --out, one a recording.
void WriteAll(const std::vector<RecordingDraft>& drafts) {
  if (!IsFolder(FLAGS_out)) {
    std::string names;
    for (const RecordingDraft& draft : drafts) names += " " + draft.name;
    throw InputError(FLAGS_out + ": is no folder; the configurations of " +
                     std::to_string(drafts.size()) +
                     " recordings are written into one:" + names);
  }
  for (const RecordingDraft& draft : drafts) {
    WriteInto(
        (std::filesystem::path(FLAGS_out) / (draft.name + ".yaml")).string(),
        draft);
  }
}

int Run(const std::vector<std::string>& arguments) {
  if (IsFolder(FLAGS_out)) {
    RequireRoomFor((std::filesystem::path(FLAGS_out) / "NAME.yaml").string());
  } else if (!FLAGS_out.empty()) {
    CheckFilePlace(FLAGS_out, {"'init'", IsInitConfig});
    RequireRoomFor(FLAGS_out);
  }
  const std::vector<RecordingDraft> drafts = [&] {
    Progress progress(Progress::ModeFromName("auto"));
    return DraftFolder(arguments[0], &progress);
  }();
  const bool all_load =
      std::all_of(drafts.begin(), drafts.end(),
                  [](const RecordingDraft& draft) { return draft.loads; });
  const int status = all_load ? kUsable : kBadInput;
  if (FLAGS_out.empty()) {
    for (const RecordingDraft& draft : drafts) {
      if (drafts.size() > 1) std::cout << "---\n";
      std::cout << DraftText(draft);
      TellProblem(draft, "standard output");
    }
    return status;
  }
  if (drafts.size() > 1 || IsFolder(FLAGS_out)) {
    WriteAll(drafts);
  } else {
    WriteInto(FLAGS_out, drafts.front());
  }
  std::cout << "look at the recording with: hindsight check CONFIG\n";
  return status;
}

}  // namespace

Command InitCommand() {
  return {
      .name = "init",
      .summary = "draft a configuration for a folder of recorded files",
      .arguments = "FOLDER",
      .help = kHelp,
      .flags = {{"out", "FILE",
                 "write the configuration there, or into a folder"},
                {"force", "", "replace FILE if 'init' wrote it"},
                {"clean", "", "remove what killed calls left beside FILE"}},
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
