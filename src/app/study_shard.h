#ifndef HINDSIGHT_APP_STUDY_SHARD_H_
#define HINDSIGHT_APP_STUDY_SHARD_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/progress.h"
#include "app/result_folder.h"
#include "app/shard_file.h"
#include "app/studies.h"

namespace hindsight {

/// Which part of the runs --shard=I/N asks for.
struct ShardNumber {
  int number = 1;  ///< from 1
  int of = 1;
  int BeginOf(int runs) const { return Share(runs, number - 1); }
  int EndOf(int runs) const { return Share(runs, number); }

 private:
  int Share(int runs, int shards) const {
    return static_cast<int>(std::int64_t{runs} * shards / of);
  }
};

/// Nothing without the flag. Throws UsageError.
std::optional<ShardNumber> ReadShardNumber(int runs);

/// What all shards of the call have in common.
ShardedCall SharedCall(const std::vector<std::string>& arguments,
                       const NamedStudy& choice, const Study& study,
                       const MonteCarloOptions& options, int shards);

/// Does the runs of a shard that has none yet, and commits the folder with it.
void RunShardInto(Shard shard, const Study& study, MonteCarloOptions options,
                  Progress* progress, ResultFolder* folder);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDY_SHARD_H_
