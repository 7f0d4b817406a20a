#include "app/campaign_slurm.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "app/command.h"
#include "app/shell_word.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr char kScriptName[] = "job.sh";
constexpr char kJobName[] = "job";

fs::path SlurmFolder(const SlurmJob& job) { return job.folder / "slurm"; }

std::string FirstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// Whether Slurm still has the job in its queue.
bool IsQueued(const std::string& job) {
  const ProgramOutput queue = RunProgram({"squeue", "-h", "-j", job});
  return queue.succeeded && !queue.text.empty();
}

}  // namespace

std::string SlurmScript(const SlurmJob& job) {
  constexpr double kOwnMegabytes = 100.0;
  std::error_code refused;
  const fs::path program = fs::read_symlink("/proc/self/exe", refused);
  std::string text = "#!/bin/bash\n";
  text += "#SBATCH --job-name=hindsight\n";
  text += fmt::format("#SBATCH --array=1-{}\n", job.tasks);
  text += "#SBATCH --ntasks=1\n#SBATCH --requeue\n";
  if (std::isfinite(job.limits.megabytes)) {
    text += fmt::format("#SBATCH --mem={:.0f}M\n",
                        std::ceil(job.limits.megabytes + kOwnMegabytes));
  }
  text += fmt::format("#SBATCH --output={}\n",
                      ShellWord((SlurmFolder(job) / "%A_%a.log").string()));
  if (!job.options.empty()) text += "#SBATCH " + job.options + "\n";
  text += "exec " + ShellWord(program.string()) +
          " campaign --out=" + ShellWord(job.folder.string()) +
          " --workers=1 --progress=none" +
          fmt::format(" --stale-after={:g}", job.stale_after);
  if (std::isfinite(job.limits.seconds)) {
    text += fmt::format(" --time-limit={:g}", job.limits.seconds);
  }
  if (std::isfinite(job.limits.megabytes)) {
    text += fmt::format(" --memory-limit={:g}", job.limits.megabytes);
  }
  return text + "\n";
}

std::string SubmitSlurm(const SlurmJob& job) {
  const fs::path folder = SlurmFolder(job);
  std::error_code refused;
  fs::create_directories(folder, refused);
  if (refused) throw OutputError(folder, refused.message());
  const fs::path last = folder / kJobName;
  if (IsFile(last)) {
    const std::string number = FirstLine(ReadTextFile(last.string()));
    if (!number.empty() && IsQueued(number)) return number;
  }
  const std::string script = (folder / kScriptName).string();
  WriteFileAtomically(script, SlurmScript(job));
  const ProgramOutput answer = RunProgram({"sbatch", "--parsable", script});
  if (!answer.found) {
    throw UsageError(
        "--engine=slurm: there is no program sbatch here; --dry-run prints "
        "the script to be handed to it elsewhere");
  }
  // "NUMBER", of a cluster among several "NUMBER;CLUSTER".
  const std::string number =
      answer.text.substr(0, answer.text.find_first_of(";\n"));
  if (!answer.succeeded || number.empty()) {
    throw EstimationError("sbatch refused " + script);
  }
  WriteFileAtomically(last.string(), number + "\n");
  return number;
}

void WatchSlurm(const std::string& job, const std::function<bool()>& is_done) {
  constexpr std::chrono::seconds kPause(2);
  constexpr int kPausesBetweenQuestions = 5;
  for (int i = 1; !is_done(); ++i) {
    if (i % kPausesBetweenQuestions == 0 && !IsQueued(job)) return;
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace hindsight
