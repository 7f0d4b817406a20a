#include "app/campaign_record.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "app/build_id.h"
#include "app/flags.h"
#include "app/run_output.h"
#include "base/error.h"
#include "io/config/config.h"
#include "io/config/constants_reader.h"
#include "io/read/file_digest.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"
#include "io/write/atomic_file.h"
#include "io/write/result_manifest.h"
#include "io/write/summary.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kSettling = 2'000'000'000;  // [ns]

std::int64_t SystemTime() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Size and time of change as they are; the rest is empty. Those of a folder
/// change with the names in it.
HashedInput FileStatus(const std::string& path) {
  HashedInput input = {.path = path, .sha256 = ""};
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return input;
  constexpr std::int64_t kSecond = 1'000'000'000;
  input.bytes = static_cast<std::uint64_t>(status.st_size);
  input.changed =
      kSecond * status.st_mtim.tv_sec + std::int64_t{status.st_mtim.tv_nsec};
  input.settled = (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) &&
                  SystemTime() - input.changed > kSettling;
  return input;
}

bool IsUnchanged(const HashedInput& known) {
  if (!known.settled) return false;
  const HashedInput now = FileStatus(known.path);
  return now.settled && now.bytes == known.bytes &&
         now.changed == known.changed;
}

/// A file, or a folder with all that is below it but behind links.
void AddWithContent(const fs::path& path, std::vector<fs::path>* inputs) {
  inputs->push_back(path);
  if (!IsFolder(path)) return;
  try {
    for (const fs::path& entry : FolderEntries(path)) {
      std::error_code ignored;
      if (IsFolder(entry) && fs::is_symlink(entry, ignored)) {
        inputs->push_back(entry);
      } else {
        AddWithContent(entry, inputs);
      }
    }
  } catch (const InputError&) {
    // Its name stands for what cannot be listed.
  }
}

std::vector<fs::path> InputsOfItem(const CampaignItem& item) {
  const std::string constants = item.Flag("constants");
  std::vector<fs::path> named = {item.config};
  if (IsFolder(item.config)) {
    if (!constants.empty()) named.push_back(SummaryOf(constants));
  } else {
    try {
      named = ConfigFilesRead(item.config.string(),
                              {.data_root = item.Flag("data-root"),
                               .without = Split(item.Flag("without"), ','),
                               .constants = constants});
    } catch (const InputError&) {
      // `run` will say what is wrong with it.
    }
  }
  if (!item.Flag("at").empty()) named.emplace_back(item.Flag("at"));
  std::vector<fs::path> inputs;
  for (const fs::path& path : named) AddWithContent(path, &inputs);
  return inputs;
}

std::string ContentDigest(const std::string& path) {
  if (!IsFolder(path)) return DigestOf(path).sha256;
  std::string names;
  for (const fs::path& entry : FolderEntries(path)) {
    names += entry.filename().string() + '\n';
  }
  return Sha256Of(names);
}

HashedInput HashedAs(const std::string& path, const ItemKey& known) {
  for (const HashedInput& one : known.inputs) {
    if (one.path == path && IsUnchanged(one)) return one;
  }
  HashedInput input = FileStatus(path);
  try {
    input.sha256 = ContentDigest(path);
  } catch (const InputError&) {
    input.settled = false;
  }
  return input;
}

void PutNumber(const char* key, const std::optional<double>& value,
               Json* json) {
  if (value) (*json)[key] = *value;
}

std::optional<double> NumberAt(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

/// Mean over all measurements used, constraints apart; absent without.
std::optional<double> NisOf(const Json& residuals) {
  double sum = 0.0;
  double count = 0.0;
  for (const Json& sensor : residuals) {
    const auto rms = NumberAt(sensor, "normalized_rms");
    if (!rms || sensor.value("supposed", false)) continue;
    const double used =
        sensor.value("count", 0.0) - sensor.value("rejected", 0.0);
    sum += used * *rms * *rms;
    count += used;
  }
  if (count <= 0.0) return std::nullopt;
  return sum / count;
}

std::string UnobservedOf(const Json& method) {
  std::set<std::string> names;
  for (const Json& span : method.value("unobserved", Json::array())) {
    names.insert(span.value("component", ""));
  }
  const Json constants = method.value("constants", Json::object());
  for (const auto& [name, constant] : constants.items()) {
    if (constant.value("verdict", "") == "unobserved") names.insert(name);
  }
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace

ItemPlace::ItemPlace(const fs::path& campaign, const CampaignItem& item)
    : folder(campaign / "items" / item.name),
      results(folder / "results"),
      log(folder / "log.txt"),
      record(folder / "item.json") {}

ItemKey KeyOf(const CampaignItem& item, const ItemKey& known) {
  ItemKey key;
  std::string text = "build " + BuildId() + "\n";
  for (const auto& [name, value] : item.flags) {
    text += "flag " + std::to_string(value.size()) + " " + name + "=" + value +
            "\n";
  }
  for (const fs::path& path : InputsOfItem(item)) {
    const HashedInput& input =
        key.inputs.emplace_back(HashedAs(path.string(), known));
    text += "input " + input.sha256 + "\n";
  }
  key.sha256 = Sha256Of(text);
  return key;
}

std::optional<ItemRecord> ReadItemRecord(const ItemPlace& place) {
  if (!IsFile(place.record)) return std::nullopt;
  try {
    const Json json = Json::parse(ReadTextFile(place.record.string()));
    ItemRecord record;
    record.key.sha256 = json.at("key");
    for (const Json& one : json.at("inputs")) {
      record.key.inputs.push_back({one.at("path"), one.at("bytes"),
                                   one.at("changed_ns"), one.at("sha256"),
                                   one.at("settled")});
    }
    record.build = json.at("build");
    record.flags = json.at("flags");
    record.done = json.at("done");
    record.reason = json.at("reason");
    record.grade = json.at("grade");
    record.best = json.at("best");
    record.unobserved = json.at("unobserved");
    record.withheld_rms = NumberAt(json, "withheld_rms_m");
    record.nis = NumberAt(json, "nis");
    record.seconds = NumberAt(json, "seconds");
    record.megabytes = NumberAt(json, "mb");
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void WriteItemRecord(const ItemRecord& record, const ItemPlace& place) {
  Json json = {{"key", record.key.sha256},
               {"build", record.build},
               {"flags", record.flags},
               {"inputs", Json::array()},
               {"done", record.done},
               {"grade", record.grade},
               {"best", record.best},
               {"reason", record.reason},
               {"unobserved", record.unobserved}};
  for (const HashedInput& input : record.key.inputs) {
    json["inputs"].push_back({{"path", input.path},
                              {"bytes", input.bytes},
                              {"changed_ns", input.changed},
                              {"sha256", input.sha256},
                              {"settled", input.settled}});
  }
  PutNumber("withheld_rms_m", record.withheld_rms, &json);
  PutNumber("nis", record.nis, &json);
  PutNumber("seconds", record.seconds, &json);
  PutNumber("mb", record.megabytes, &json);
  const auto replace = Json::error_handler_t::replace;
  WriteFileAtomically(place.record.string(),
                      json.dump(1, ' ', false, replace) + "\n");
}

bool IsCertainlyOf(const ItemRecord& record, const CampaignItem& item) {
  return record.build == BuildId() && record.flags == item.flags &&
         !record.key.inputs.empty() &&
         record.key.inputs.front().path == item.config.string() &&
         std::all_of(record.key.inputs.begin(), record.key.inputs.end(),
                     IsUnchanged);
}

bool TakeResults(const ItemPlace& place, ItemRecord* record) {
  const auto manifest = ReadManifest(place.results);
  if (!manifest || !manifest->complete) return false;
  try {
    const Json json =
        Json::parse(ReadTextFile((place.results / kSummaryName).string()));
    record->best = json.at("best");
    record->grade = json.at("grade");
    const Json& method = json.at("methods").at(record->best);
    record->reason = method.value("verdict", "");
    record->withheld_rms =
        NumberAt(method.value("withheld", Json::object()), "horizontal_rms_m");
    record->nis = NisOf(method.value("residuals", Json::object()));
    record->unobserved = UnobservedOf(method);
    record->done = true;
  } catch (const Json::exception&) {
    return false;
  } catch (const InputError&) {
    return false;
  }
  return true;
}

std::string FailureOf(const ChildEnd& end, const ChildLimits& limits,
                      const ItemPlace& place) {
  if (end.over_time) {
    return fmt::format("over its time limit of {:g} s", limits.seconds);
  }
  if (end.signal != 0) {
    return fmt::format("ended by signal {} ({})", end.signal,
                       strsignal(end.signal));
  }
  constexpr std::string_view kMark = "hindsight: error: ";
  std::string log;
  try {
    log = ReadTextFile(place.log.string());
  } catch (const InputError&) {
    // It is told that there is none.
  }
  const std::size_t begin = log.rfind(kMark);
  if (begin == log.npos) {
    return fmt::format("ended with status {} and no word", end.status);
  }
  std::string reason = log.substr(begin + kMark.size());
  reason.resize(std::min(reason.find('\n'), reason.size()));
  const bool no_memory = reason == "out of memory";
  if (no_memory && std::isfinite(limits.megabytes)) {
    reason += fmt::format(" (limit {:g} MB)", limits.megabytes);
  }
  return reason;
}

}  // namespace hindsight
