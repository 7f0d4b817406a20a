#include "app/shard_file.h"

#include <nlohmann/json.hpp>

#include "app/flags.h"
#include "app/shell_word.h"
#include "base/error.h"
#include "io/read/text_file.h"
#include "io/write/result_manifest.h"

namespace hindsight {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ShardedCall, build, arguments, flags, inputs,
                                   study, name, settings, labels, runs,
                                   first_seed, shards)

using Cbor = nlohmann::json;

/// Of a record, whose series are in the folds.
void to_json(Cbor& json, const RunRecord& r) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, value] : r.values) {
    names.push_back(name);
    values.push_back(value);
  }
  json = {r.table,    r.labels,
          r.seed,     r.failed,
          r.answered, r.grade ? static_cast<int>(*r.grade) : -1,
          r.refusal,  Joined(names, "\n"),
          values};
}

void from_json(const Cbor& json, RunRecord& r) {
  const auto grade = json.at(5).get<int>();
  if (grade >= 0) r.grade = static_cast<Grade>(grade);
  json.at(0).get_to(r.table);
  json.at(1).get_to(r.labels);
  json.at(2).get_to(r.seed);
  json.at(3).get_to(r.failed);
  json.at(4).get_to(r.answered);
  json.at(6).get_to(r.refusal);
  const std::vector<std::string> names =
      Split(json.at(7).get<std::string>(), '\n');
  const auto values = json.at(8).get<std::vector<double>>();
  for (std::size_t i = 0; i < names.size(); ++i) {
    r.values.emplace_back(names[i], values.at(i));
  }
}

void to_json(Cbor& json, const SeriesFold::Moments& m) {
  json = {m.runs, m.mean, m.squares};
}
void from_json(const Cbor& json, SeriesFold::Moments& m) {
  json.at(0).get_to(m.runs);
  json.at(1).get_to(m.mean);
  json.at(2).get_to(m.squares);
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SeriesFold, t, series)

void to_json(Cbor& json, const FoldTree& tree) {
  json = Cbor::array();
  for (const auto& [begin, node] : tree.nodes()) {
    json.push_back({node.level, node.index, node.cells});
  }
}
void from_json(const Cbor& json, FoldTree& tree) {
  for (const Cbor& node : json) {
    tree.Add({node.at(0).get<int>(), node.at(1).get<std::int64_t>(),
              node.at(2).get<CellFolds>()});
  }
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CaseRuns, records, folds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StudyShard, begin, end, cases)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Shard, call, number, result)

std::string ShardedCall::WordsOf(int shard) const {
  std::string text = "hindsight montecarlo";
  for (const std::string& word : arguments) text += " " + ShellWord(word);
  for (const auto& [name, value] : flags) {
    text += " " + ShellWord("--" + name + "=" + value);
  }
  return text + " --runs=" + std::to_string(runs) +
         " --seed=" + std::to_string(first_seed) +
         " --shard=" + std::to_string(shard) + "/" + std::to_string(shards);
}

OutputFile ShardOutput(const Shard& shard) {
  OutputFile file = {kShardName, ""};
  Cbor::to_cbor(shard, file.text);
  return file;
}

Shard ReadShard(const std::filesystem::path& folder) {
  const auto manifest = ReadManifest(folder);
  if (!manifest || !manifest->complete) {
    throw InputError(folder.string() +
                     " holds no results of 'montecarlo --shard'");
  }
  const std::string path = (folder / kShardName).string();
  const std::string text = ReadTextFile(path);
  try {
    return Cbor::from_cbor(text).get<Shard>();
  } catch (const std::logic_error& error) {
    throw InputError(path, 0, std::string("damaged: ") + error.what());
  } catch (const Cbor::exception& error) {
    throw InputError(path, 0, std::string("damaged: ") + error.what());
  }
}

}  // namespace hindsight
