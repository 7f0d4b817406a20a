#include "app/study_shard.h"

#include <gflags/gflags.h>

#include <cmath>
#include <iostream>
#include <utility>

#include "app/build_id.h"
#include "app/flags.h"
#include "app/study_cases.h"
#include "io/read/file_digest.h"
#include "io/read/units.h"

namespace hindsight {

std::optional<ShardNumber> ReadShardNumber(int runs) {
  if (!IsGiven("shard")) return std::nullopt;
  const std::vector<std::string> words = Split(FLAGS_shard, '/');
  const auto number = words.size() == 2 ? ParseNumber(words[0]) : std::nullopt;
  const auto of = words.size() == 2 ? ParseNumber(words[1]) : std::nullopt;
  const bool is_right = number && of && *number == std::floor(*number) &&
                        *of == std::floor(*of) && *number >= 1.0 &&
                        *number <= *of && *of <= runs;
  if (!is_right) {
    throw UsageError("--shard=" + FLAGS_shard +
                     ": expected I/N, the I-th of N shards, N at most the " +
                     std::to_string(runs) + " runs");
  }
  return ShardNumber{static_cast<int>(*number), static_cast<int>(*of)};
}

ShardedCall SharedCall(const std::vector<std::string>& arguments,
                       const NamedStudy& choice, const Study& study,
                       const MonteCarloOptions& options, int shards) {
  ShardedCall call = {.build = BuildId(),
                      .arguments = arguments,
                      .flags = {},
                      .inputs = {},
                      .study = choice.help.empty() ? "" : choice.name,
                      .name = study.name,
                      .settings = study.settings,
                      .labels = study.tables[0].labels,
                      .runs = options.runs,
                      .first_seed = options.first_seed,
                      .shards = shards};
  for (const std::string& flag : choice.flags) {
    if (!IsGiven(flag)) continue;
    call.flags[Dashed(flag)] =
        gflags::GetCommandLineFlagInfoOrDie(flag.c_str()).current_value;
  }
  for (const auto& file : FilesOf(arguments)) {
    call.inputs.push_back(DigestOf(file).sha256);
  }
  return call;
}

void RunShardInto(Shard shard, const Study& study, MonteCarloOptions options,
                  Progress* progress, ResultFolder* folder) {
  options.progress = [&](double done) { progress->Update("runs", done); };
  StudyRun run(study, options, shard.result.begin, shard.result.end);
  run.Do();
  shard.result = run.shard();
  progress->Clear();
  folder->Write(ShardOutput(shard));
  folder->Commit();
  std::cout << "shard " << shard.number << "/" << shard.call.shards << ", runs "
            << shard.result.begin + 1 << " to " << shard.result.end << " of "
            << options.runs << ", in " << FLAGS_out
            << "; 'hindsight merge' puts all shards together\n";
}

}  // namespace hindsight
