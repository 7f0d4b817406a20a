#include <nlohmann/json.hpp>

#include "base/units.h"
#include "io/read/time_scale.h"
#include "io/write/allan_json.h"
#include "io/write/json_put.h"
#include "io/write/method_json.h"
#include "io/write/summary.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

Json InputJson(const FileDigest& input) {
  Json json = {
      {"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}};
  if (input.files != 1) json["files"] = input.files;
  return json;
}

Json FixesJson(const FixSummary& fixes) {
  Json json = {{"count", fixes.count}};
  PutValue(&json, "satellites_mean", fixes.satellites);
  for (const auto& [quality, count] : fixes.by_quality) {
    json["quality_percent"][std::to_string(quality)] =
        100.0 * static_cast<double>(count) / static_cast<double>(fixes.count);
  }
  return json;
}

void PutSpans(Json* json, const std::string& key,
              const std::vector<StreamSpan>& spans) {
  for (const StreamSpan& span : spans) {
    Json entry;
    PutText(&entry, "stream", span.stream);
    PutValue(&entry, "t_begin_s", span.t_begin);
    PutValue(&entry, "t_end_s", span.t_end);
    (*json)[key].push_back(std::move(entry));
  }
}

Json EpochJson(std::int64_t gps_ns) {
  const GpsWeekTime time = GpsWeekOf(gps_ns);
  return {{"gps_week", time.week},
          {"gps_second", time.seconds},
          {"utc", FormatUtcTime(gps_ns)}};
}

Json StartJson(const StartSummary& start) {
  Json json;
  PutValue(&json, "t_s", start.t);
  PutText(&json, "position", start.position);
  PutText(&json, "attitude", start.attitude);
  PutText(&json, "heading", start.heading);
  PutText(&json, "alignment", start.alignment);
  PutText(&json, "why", start.why);
  PutValue(&json, "position_sigma_m", start.position_sigma);
  PutValue(&json, "velocity_sigma_mps", start.velocity_sigma);
  PutValue(&json, "attitude_sigma_deg",
           Eigen::Vector3d(start.attitude_sigma / kDegree));
  return json;
}

}  // namespace

nlohmann::ordered_json SummaryJson(const RunSummary& summary) {
  Json json;
  json["program"] = summary.program;
  json["dataset"] = summary.dataset;
  json["complete"] = summary.complete;
  if (summary.epoch_gps_ns) json["epoch"] = EpochJson(*summary.epoch_gps_ns);
  PutText(&json, "constants_from", summary.constants_from);
  PutWords(&json, "constants_of_recording", summary.constants_of_recording);
  if (summary.start) json["datum"] = "WGS-84, heights above the ellipsoid";
  for (const FileDigest& input : summary.inputs) {
    json["inputs"].push_back(InputJson(input));
  }
  for (const FixSummary& fixes : summary.fixes) {
    json["fixes"][fixes.stream] = FixesJson(fixes);
  }
  if (summary.start) json["start"] = StartJson(*summary.start);
  for (const PolicyCount& policy : summary.policies) {
    json["policies"].push_back({{"stream", policy.stream},
                                {"action", policy.action},
                                {"count", policy.count}});
  }
  PutWords(&json, "warnings", summary.warnings);
  PutWords(&json, "notes", summary.notes);
  PutUnobserved(summary.unobserved, &json);
  PutSpans(&json, "gaps", summary.gaps);
  PutSpans(&json, "rests", summary.rests);
  if (summary.allan) json["allan"] = AllanJson(*summary.allan);
  for (const MethodSummary& m : summary.methods) {
    if (m.method != summary.best) continue;
    json["best"] = m.method;
    json["grade"] = GradeName(m.grade);
  }
  json["methods"] = Json::object();
  for (const MethodSummary& m : summary.methods) {
    json["methods"][m.method] = MethodJson(m);
  }
  return json;
}

std::string SummaryText(const RunSummary& summary) {
  return SummaryJson(summary).dump(2) + "\n";
}

}  // namespace hindsight
