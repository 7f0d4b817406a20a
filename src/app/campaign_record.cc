#include "app/campaign_record.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "app/build_id.h"
#include "app/run_output.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"
#include "io/write/atomic_file.h"
#include "io/write/result_manifest.h"
#include "io/write/summary.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

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
