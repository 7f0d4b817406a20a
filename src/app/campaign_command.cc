#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "app/campaign.h"
#include "app/campaign_folder.h"
#include "app/campaign_slurm.h"
#include "app/campaign_table.h"
#include "app/command.h"
#include "app/flags.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "base/error.h"
#include "base/parallel.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr const char* kHelp =
    R"(Reconstructs many recordings, each by a process 'hindsight run' of its own. A
LIST is a configuration, a folder with config.yaml, a recording's folder without
one (as of 'run FOLDER'), a pattern of these in quotes ('survey/*/config.yaml'),
or a CSV: a line an item with columns config, name (not needed where the folders'
names differ) and any flags of 'run'. Flags of 'run' given here hold for all
items.

Any number of such calls, on any machines that share the folder of --out, work
together: each item is claimed by a file that its owner keeps touching. What is
done stays done: a further call does what is new, whose configuration, inputs,
flags or program have changed, or that was under way when a worker died. Files
of unchanged size and time are not read again. Without a LIST it is that of the
call before. Folder of --out:
  campaign.csv         a line an item, worst first: state, grade, error against
                       withheld positions, NIS, what is unobserved, why, seconds,
                       MB
  campaign.html        the same as a page with links to the reports
  items.csv            the items, a CSV as above
  items/NAME/results   of 'run'
  items/NAME/log.txt   what it printed
  items/NAME/item.json how it ended, and the hashes that decide its key
Ctrl-C ends the processes; the same call goes on. The exit status is 0 if every
item has results, of whatever grade, and 1 if some have failed or are left open.
)";

constexpr char kTableName[] = "campaign.csv";
constexpr char kPageName[] = "campaign.html";

std::vector<FlagUse> OwnFlags() {
  return {{"out", "DIR", "folder of the campaign (required)"},
          {"workers", "N",
           "items at once; of slurm: tasks of the array\n"
           "(as many as there are cores; of slurm 10)"},
          {"time_limit", "SECONDS", "of each item, by the clock (none)"},
          {"memory_limit", "MB", "of each item (none)"},
          {"retry", "", "try what failed before once more"},
          {"collect", "",
           "work on nothing: campaign.csv and campaign.html of what\n"
           "is there"},
          {"stale_after", "SECONDS",
           "an owner that has not touched its claim for so long, by\n"
           "the file server's clock, is dead (60)"},
          {"engine", "NAME",
           "local, or slurm: submits an array of workers, watches it\n"
           "and collects (local)"},
          {"dry_run", "", "of slurm: print the script and submit nothing"},
          {"sbatch", "OPTIONS",
           "of slurm: further options, '--partition=night --time=8:00:00'"},
          {"progress", "MODE",
           "on stderr: auto (a line on a terminal), json or none (auto)"}};
}

std::vector<FlagUse> Flags() {
  std::vector<FlagUse> flags = OwnFlags();
  for (const FlagUse& flag : PassedFlags()) flags.push_back(flag);
  return flags;
}

/// Flags of `run` that the command line gives.
std::map<std::string, std::string> GivenFlags() {
  std::map<std::string, std::string> given;
  for (const FlagUse& flag : PassedFlags()) {
    if (!IsGiven(flag.name)) continue;
    given[Dashed(flag.name)] =
        gflags::GetCommandLineFlagInfoOrDie(flag.name.c_str()).current_value;
  }
  return given;
}

void RequirePositive(const std::string& flag, double value) {
  if (value > 0.0) return;
  throw UsageError("--" + flag + ": expected more than zero");
}

void CheckFlags() {
  if (FLAGS_out.empty()) {
    throw UsageError("'campaign' needs --out=DIR, the folder of the campaign");
  }
  RequirePositive("time-limit", FLAGS_time_limit);
  RequirePositive("memory-limit", FLAGS_memory_limit);
  RequirePositive("stale-after", FLAGS_stale_after);
  constexpr std::uint64_t kMostWorkers = 1024;
  if (FLAGS_workers > kMostWorkers) {
    throw UsageError("--workers=" + std::to_string(FLAGS_workers) +
                     ": expected 0 to 1024");
  }
  if (FLAGS_engine != "local" && FLAGS_engine != "slurm") {
    throw UsageError("--engine=" + FLAGS_engine + ": expected local or slurm");
  }
  if (FLAGS_engine == "slurm") return;
  for (const char* flag : {"dry_run", "sbatch"}) {
    if (!IsGiven(flag)) continue;
    throw UsageError("--" + Dashed(flag) + " goes with --engine=slurm");
  }
}

int Report(const std::vector<CampaignItem>& items, const fs::path& folder) {
  const std::vector<CampaignRow> rows = ReadCampaign(items, folder);
  WriteIfOther(folder / kTableName, CampaignCsv(rows));
  WriteIfOther(folder / kPageName, CampaignPage(rows, folder));
  std::cout << CampaignText(rows) << "table in "
            << (folder / kTableName).string() << ", page in "
            << (folder / kPageName).string() << "\n";
  const bool is_all_done = std::all_of(
      rows.begin(), rows.end(),
      [](const CampaignRow& row) { return row.record && row.record->done; });
  return is_all_done ? kUsable : kUnusable;
}

void WorkHere(const std::vector<CampaignItem>& items, const fs::path& folder,
              Progress* progress) {
  Campaign campaign(
      items, {.folder = folder,
              .workers = FLAGS_workers > 0 ? static_cast<int>(FLAGS_workers)
                                           : ThreadCount(),
              .limits = {FLAGS_time_limit, FLAGS_memory_limit},
              .stale_after = FLAGS_stale_after,
              .progress = [progress](double done) {
                progress->Update("items", done);
              }});
  const StopWatch watch([&campaign]() -> std::string {
    campaign.Stop();
    return "interrupted; what was under way is left open, the same call goes "
           "on";
  });
  campaign.Work();
}

/// Until no item is open, or the job has ended.
void WorkBySlurm(const std::vector<CampaignItem>& items, const SlurmJob& job,
                 Progress* progress) {
  // Each look asks for those alone that had not ended at the last.
  std::vector<const CampaignItem*> open;
  for (const CampaignItem& item : items) open.push_back(&item);
  const auto is_done = [&] {
    std::erase_if(open, [&](const CampaignItem* item) {
      return RecordOf(*item, ItemPlace(job.folder, *item)).has_value();
    });
    progress->Update("items", 1.0 - static_cast<double>(open.size()) /
                                        static_cast<double>(items.size()));
    return open.empty();
  };
  if (is_done()) return;
  const std::string number = SubmitSlurm(job);
  progress->Clear();
  std::cout << "job " << number << " of Slurm (scancel " << number
            << " ends it); the same call watches it again\n"
            << std::flush;
  WatchSlurm(number, is_done);
  if (!is_done()) {
    progress->Clear();
    std::cout << "job " << number
              << " has left the queue; the same call submits what is open\n";
  }
}

int Run(const std::vector<std::string>& list) {
  CheckFlags();
  Progress progress(Progress::ModeFromName(FLAGS_progress));
  fs::path folder = fs::absolute(FLAGS_out).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  const std::vector<CampaignItem> items = ItemsOf(list, GivenFlags(), folder);
  constexpr int kTasks = 10;
  const int tasks =
      FLAGS_workers > 0 ? static_cast<int>(FLAGS_workers) : kTasks;
  const SlurmJob job = {
      .folder = folder,
      .tasks =
          std::clamp(tasks, 1, std::max(1, static_cast<int>(items.size()))),
      .limits = {FLAGS_time_limit, FLAGS_memory_limit},
      .stale_after = FLAGS_stale_after,
      .options = FLAGS_sbatch};
  if (FLAGS_dry_run) {
    std::cout << SlurmScript(job);
    return kUsable;
  }
  if (FLAGS_retry) ForgetFailures(items, folder);
  if (!FLAGS_collect && FLAGS_engine == "slurm") {
    WorkBySlurm(items, job, &progress);
  } else if (!FLAGS_collect) {
    WorkHere(items, folder, &progress);
  }
  progress.Finish();
  return Report(items, folder);
}

}  // namespace

Command CampaignCommand() {
  return {
      .name = "campaign",
      .summary = "reconstruct many recordings, on one machine or many",
      .arguments = "[LIST ...]",
      .help = kHelp,
      .flags = Flags(),
      .min_arguments = 0,
      .max_arguments = 100000,
      .run = Run,
  };
}

}  // namespace hindsight
