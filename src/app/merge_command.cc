#include <algorithm>

#include "app/build_id.h"
#include "app/command.h"
#include "app/flags.h"
#include "app/result_folder.h"
#include "app/shard_file.h"
#include "app/studies.h"
#include "app/study_report.h"
#include "base/error.h"
#include "problems/navigation_trial.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Puts the shards of one comparison, folders of 'montecarlo --shard=I/N', together
to what 'montecarlo' writes without --shard: the CSVs have the same bytes as
those of one process, whatever N is and however the shards were made. All N are
needed, each once; one that is missing is named with the call that makes it.
Shards of other builds of the program are refused, as are those of another
scenario, other flags or other seeds.
)";

/// A shard and the folder that it was read from.
struct PlacedShard {
  std::string folder;
  Shard shard;
};

void CheckAlike(const PlacedShard& first, const PlacedShard& other) {
  const ShardedCall& a = first.shard.call;
  const ShardedCall& b = other.shard.call;
  const std::string both = first.folder + " and " + other.folder;
  if (a.inputs != b.inputs) {
    throw InputError(both + " are of different content of the scenario");
  }
  if (a == b) return;
  throw InputError(
      both + " are not of one comparison: " + a.WordsOf(first.shard.number) +
      " against " + b.WordsOf(other.shard.number));
}

void CheckBuild(const PlacedShard& one) {
  if (one.shard.call.build == BuildId()) return;
  throw InputError(one.folder + " is of another build of the program (" +
                   one.shard.call.build + ") than this one (" + BuildId() +
                   ")");
}

/// All that are needed, each once, in their order.
void CheckNumbers(const std::vector<PlacedShard>& placed) {
  for (std::size_t i = 1; i < placed.size(); ++i) {
    if (placed[i].shard.number != placed[i - 1].shard.number) continue;
    throw InputError("shard " + std::to_string(placed[i].shard.number) +
                     " is there twice: " + placed[i - 1].folder + " and " +
                     placed[i].folder);
  }
  const ShardedCall& call = placed.front().shard.call;
  for (int number = 1; number <= call.shards; ++number) {
    const auto i = static_cast<std::size_t>(number - 1);
    if (i < placed.size() && placed[i].shard.number == number) continue;
    throw InputError("shard " + std::to_string(number) + "/" +
                     std::to_string(call.shards) + " is missing: run " +
                     call.WordsOf(number));
  }
}

std::vector<PlacedShard> ReadShards(const std::vector<std::string>& folders) {
  std::vector<PlacedShard> placed;
  for (const std::string& folder : folders) {
    placed.push_back({folder, ReadShard(folder)});
    CheckBuild(placed.back());
    CheckAlike(placed.front(), placed.back());
  }
  std::ranges::stable_sort(
      placed, {}, [](const PlacedShard& one) { return one.shard.number; });
  CheckNumbers(placed);
  return placed;
}

/// Its tables, settings and name; of its cases nothing is asked.
Study StudyOf(const ShardedCall& call) {
  for (const NamedStudy& named : NamedStudies()) {
    if (named.name != call.study) continue;
    for (const auto& [name, value] : call.flags) GiveFlag(name, value);
    Study study = named.make();
    study.name = call.name;
    return study;
  }
  std::vector<std::string> columns = call.labels;
  columns.pop_back();
  Study study = {.name = call.name, .settings = call.settings, .tables = {}};
  for (const StudyTable& table : NavigationTables()) {
    study.tables.push_back(Under(columns, table));
  }
  return study;
}

int Run(const std::vector<std::string>& folders) {
  if (FLAGS_out.empty()) {
    throw UsageError("'merge' needs --out=DIR, the folder for the results");
  }
  std::vector<PlacedShard> placed = ReadShards(folders);
  const ShardedCall call = placed.front().shard.call;
  const MonteCarloOptions options = {.runs = call.runs,
                                     .first_seed = call.first_seed};
  const Study study = StudyOf(call);
  StudyShard all = std::move(placed.front().shard.result);
  for (std::size_t i = 1; i < placed.size(); ++i) {
    all.Append(std::move(placed[i].shard.result));
  }
  return WithResultFolder(
      {FLAGS_out, FLAGS_force, FLAGS_clean},
      [&]() -> ResultFolder::Paths {
        return {folders.begin(), folders.end()};
      },
      [&](ResultFolder* folder) {
        const StudyResult result(study.tables, all, all.cases.size());
        result.RequireAnswer();
        ReportStudy(study, result, options, folder);
        return kUsable;
      });
}

}  // namespace

Command MergeCommand() {
  return {
      .name = "merge",
      .summary = "put the shards of a montecarlo together",
      .arguments = "DIR [DIR2 ...]",
      .help = kHelp,
      .flags = {{"out", "DIR", "folder for the results (required)"},
                {"force", "",
                 "replace DIR if it holds nothing but results of an\n"
                 "earlier call, by its manifest.json"},
                {"clean", "", "remove what killed calls left beside DIR"},
                {"report", "", "write report.html as well"}},
      .min_arguments = 1,
      .max_arguments = 100000,
      .run = Run,
  };
}

}  // namespace hindsight
