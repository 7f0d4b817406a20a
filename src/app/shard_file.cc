#include "app/shard_file.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "app/shell_word.h"
#include "base/error.h"
#include "io/read/text_file.h"
#include "io/write/result_manifest.h"

namespace hindsight {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ShardedCall, build, arguments, flags, inputs,
                                   study, name, settings, labels, runs,
                                   first_seed, shards)
/// The rest of a record is packed.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunRecord, table, labels, seed, failed,
                                   answered, refusal)

namespace {

using Cbor = nlohmann::json;

Cbor Packed(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(double));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return Cbor::binary(std::move(bytes));
}

std::vector<double> Unpacked(const Cbor& json) {
  const auto& bytes = json.get_binary();
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) {
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  }
  return values;
}

/// Names of a record's values; most records share one such list.
class NameLists {
 public:
  std::size_t NumberOf(const std::vector<std::string>& names) {
    const auto [at, is_new] = numbers_.try_emplace(names, numbers_.size());
    if (is_new) lists_.push_back(names);
    return at->second;
  }
  const std::vector<std::vector<std::string>>& lists() const { return lists_; }

 private:
  std::map<std::vector<std::string>, std::size_t> numbers_;
  std::vector<std::vector<std::string>> lists_;
};

Cbor RecordJson(const RunRecord& record, NameLists* lists) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, value] : record.values) {
    names.push_back(name);
    values.push_back(value);
  }
  Cbor json = record;
  json["names"] = lists->NumberOf(names);
  json["values"] = Packed(values);
  if (record.grade) json["grade"] = static_cast<int>(*record.grade);
  if (!record.t.empty()) json["t"] = Packed(record.t);
  for (const auto& [name, series] : record.series) {
    json["series"][name] = Packed(series);
  }
  return json;
}

RunRecord UnpackRecord(const Cbor& json,
                       const std::vector<std::vector<std::string>>& lists) {
  auto record = json.get<RunRecord>();
  const std::vector<std::string>& names =
      lists.at(json.at("names").get<std::size_t>());
  const std::vector<double> values = Unpacked(json.at("values"));
  for (std::size_t i = 0; i < names.size(); ++i) {
    record.values.emplace_back(names[i], values.at(i));
  }
  if (json.contains("grade")) {
    record.grade = static_cast<Grade>(json["grade"].get<int>());
  }
  if (json.contains("t")) record.t = Unpacked(json["t"]);
  const Cbor all_series = json.value("series", Cbor::object());
  for (const auto& [name, series] : all_series.items()) {
    record.series[name] = Unpacked(series);
  }
  return record;
}

Cbor NodeJson(const FoldTree::Node& node) {
  Cbor json = {
      {"level", node.level}, {"index", node.index}, {"cells", Cbor::array()}};
  for (const auto& [cell, fold] : node.cells) {
    Cbor one = {{"table", cell.first},
                {"labels", cell.second},
                {"t", Packed(fold.t)},
                {"series", Cbor::object()}};
    for (const auto& [name, moments] : fold.series) {
      one["series"][name] = {{"runs", moments.runs},
                             {"mean", Packed(moments.mean)},
                             {"squares", Packed(moments.squares)}};
    }
    json["cells"].push_back(std::move(one));
  }
  return json;
}

FoldTree::Node UnpackNode(const Cbor& json) {
  FoldTree::Node node = {json.at("level"), json.at("index"), {}};
  for (const Cbor& one : json.at("cells")) {
    SeriesFold fold;
    fold.t = Unpacked(one.at("t"));
    for (const auto& [name, moments] : one.at("series").items()) {
      fold.series[name] = {moments.at("runs"), Unpacked(moments.at("mean")),
                           Unpacked(moments.at("squares"))};
    }
    node.cells[{one.at("table"), one.at("labels")}] = std::move(fold);
  }
  return node;
}

Cbor JobJson(const JobRuns& job, NameLists* lists) {
  Cbor json = {{"runs", Cbor::array()}, {"nodes", Cbor::array()}};
  for (const auto& [run, records] : job.records) {
    Cbor of_run = Cbor::array();
    for (const RunRecord& record : records) {
      of_run.push_back(RecordJson(record, lists));
    }
    json["runs"].push_back({{"run", run}, {"records", std::move(of_run)}});
  }
  for (const auto& [begin, node] : job.folds.nodes()) {
    json["nodes"].push_back(NodeJson(node));
  }
  return json;
}

JobRuns UnpackJob(const Cbor& json,
                  const std::vector<std::vector<std::string>>& lists) {
  JobRuns job;
  for (const Cbor& run : json.at("runs")) {
    std::vector<RunRecord>& records = job.records[run.at("run").get<int>()];
    for (const Cbor& record : run.at("records")) {
      records.push_back(UnpackRecord(record, lists));
    }
  }
  for (const Cbor& node : json.at("nodes")) job.folds.Add(UnpackNode(node));
  return job;
}

}  // namespace

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
  NameLists lists;
  Cbor json = {{"call", shard.call},
               {"number", shard.number},
               {"begin", shard.result.begin},
               {"end", shard.result.end},
               {"jobs", Cbor::array()}};
  for (const JobRuns& job : shard.result.jobs) {
    json["jobs"].push_back(JobJson(job, &lists));
  }
  json["names"] = lists.lists();
  OutputFile file = {kShardName, ""};
  Cbor::to_cbor(json, file.text);
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
    const Cbor json = Cbor::from_cbor(text);
    const auto lists =
        json.at("names").get<std::vector<std::vector<std::string>>>();
    Shard shard = {json.at("call"),
                   json.at("number"),
                   {json.at("begin"), json.at("end"), {}}};
    for (const Cbor& job : json.at("jobs")) {
      shard.result.jobs.push_back(UnpackJob(job, lists));
    }
    return shard;
  } catch (const std::logic_error& error) {
    throw InputError(path, 0, std::string("damaged: ") + error.what());
  } catch (const Cbor::exception& error) {
    throw InputError(path, 0, std::string("damaged: ") + error.what());
  }
}

}  // namespace hindsight
