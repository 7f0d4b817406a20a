#ifndef HINDSIGHT_APP_SHARD_FILE_H_
#define HINDSIGHT_APP_SHARD_FILE_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/result_folder.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// What all shards of one comparison have in common.
struct ShardedCall {
  std::string build;                         ///< of the program
  std::vector<std::string> arguments;        ///< of montecarlo
  std::map<std::string, std::string> flags;  ///< that decide the results
  std::vector<std::string> inputs;           ///< SHA-256 of scenario files
  std::string study;  ///< NamedStudy, "" of any scenarios
  std::string name;   ///< of the Study, and its settings
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<std::string> labels;  ///< of its first table, the method last
  int runs = 0;
  std::uint64_t first_seed = 1;
  int shards = 1;

  bool operator==(const ShardedCall&) const = default;
  /// The call of that shard but for --out, for a shell.
  std::string WordsOf(int shard) const;
};

/// One of them.
struct Shard {
  ShardedCall call;
  int number = 1;  ///< from 1
  StudyShard result;
};

/// Name of the file that a shard's folder holds.
inline constexpr char kShardName[] = "shard.cbor";

/// CBOR (RFC 8949); doubles as they are in memory.
OutputFile ShardOutput(const Shard& shard);

/// Throws InputError where the folder holds no complete shard.
Shard ReadShard(const std::filesystem::path& folder);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_SHARD_FILE_H_
