#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/units.h"
#include "io/read/time_scale.h"
#include "io/write/allan_json.h"
#include "io/write/summary.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

/// Leaves out what is no number, so that no reader meets a null.
void Put(Json* json, const std::string& key, double value) {
  if (std::isfinite(value)) (*json)[key] = value;
}

void Put(Json* json, const std::string& key,
         const std::optional<double>& value) {
  if (value) Put(json, key, *value);
}

void Put(Json* json, const std::string& key, const Eigen::Vector3d& v) {
  if (v.allFinite()) (*json)[key] = {v.x(), v.y(), v.z()};
}

void PutText(Json* json, const std::string& key, const std::string& text) {
  if (!text.empty()) (*json)[key] = text;
}

void PutWords(Json* json, const std::string& key,
              const std::vector<std::string>& words) {
  if (!words.empty()) (*json)[key] = words;
}

Eigen::Vector3d Rms(const std::array<ErrorStatistics, 3>& axis) {
  return {axis[0].rms, axis[1].rms, axis[2].rms};
}

Eigen::Vector3d Max(const std::array<ErrorStatistics, 3>& axis) {
  return {axis[0].max, axis[1].max, axis[2].max};
}

Json ErrorJson(const TrajectoryStatistics& s) {
  Json json = Json::object();
  if (s.position) {
    Put(&json, "position_rms_m", Rms(s.position->axis));
    Put(&json, "position_max_m", Max(s.position->axis));
    Put(&json, "horizontal_rms_m", s.position->horizontal.rms);
    Put(&json, "horizontal_max_m", s.position->horizontal.max);
    Put(&json, "total_rms_m", s.position->total.rms);
    Put(&json, "total_max_m", s.position->total.max);
    Put(&json, "end_horizontal_m", s.final_horizontal);
    Put(&json, "distance_m", s.distance);
  }
  if (s.velocity) {
    Put(&json, "velocity_rms_mps", Rms(s.velocity->axis));
    Put(&json, "velocity_max_mps", Max(s.velocity->axis));
  }
  if (s.attitude) {
    Put(&json, "attitude_rms_deg", Rms(s.attitude->axis) / kDegree);
    Put(&json, "attitude_max_deg", Max(s.attitude->axis) / kDegree);
    Put(&json, "tilt_rms_deg", s.attitude->tilt.rms / kDegree);
  }
  Put(&json, "matched_percent", s.matched_percent());
  return json;
}

void PutPrediction(const PredictionError& error, const std::string& prefix,
                   const std::string& unit, Json* json) {
  Put(json, prefix + "horizontal_rms_" + unit, error.horizontal_rms);
  Put(json, prefix + "horizontal_max_" + unit, error.horizontal_max);
  Put(json, prefix + "total_rms_" + unit, error.total_rms);
  Put(json, prefix + "total_max_" + unit, error.total_max);
}

Json OutageJson(const OutageError& outage, const std::string& sensor) {
  Json json;
  json["sensor"] = sensor;
  Put(&json, "t_begin_s", outage.outage.t_begin);
  Put(&json, "t_end_s", outage.outage.t_end);
  json["count"] = outage.count;
  const bool is_position = outage.kind->is_position;
  if (outage.error) {
    PutPrediction(*outage.error, "", is_position ? "m" : "mps", &json);
  }
  Put(&json, "distance_m", outage.distance);
  Put(&json, "drift_percent", outage.drift_percent);
  return json;
}

Json WithheldJson(const MethodSummary& m) {
  Json json = Json::object();
  if (const auto e = PoolOutageErrors(m.outages, PositionKind())) {
    PutPrediction(*e, "", "m", &json);
  }
  if (const auto e = PoolOutageErrors(m.outages, VelocityKind())) {
    Put(&json, "velocity_horizontal_rms_mps", e->horizontal_rms);
    Put(&json, "velocity_horizontal_max_mps", e->horizontal_max);
  }
  json["outages"] = Json::array();
  for (std::size_t i = 0; i < m.outages.size(); ++i) {
    json["outages"].push_back(OutageJson(m.outages[i], m.outage_sensors[i]));
  }
  return json;
}

Json NeesJson(const TrajectoryStatistics& s) {
  Json json;
  Put(&json, "position", s.position_nees);
  Put(&json, "velocity", s.velocity_nees);
  Put(&json, "attitude", s.attitude_nees);
  if (s.attitude_inside) {
    Put(&json, "attitude_inside_3_sigma_percent", 100.0 * *s.attitude_inside);
  }
  return json;
}

Json ResidualsJson(const std::vector<ResidualStatistics>& residuals) {
  Json json = Json::object();
  for (const ResidualStatistics& s : residuals) {
    Json& entry = json[s.sensor];
    entry["count"] = s.count;
    entry["rejected"] = s.rejected;
    if (s.withheld > 0) entry["withheld"] = s.withheld;
    PutText(&entry, "unit", std::string(s.kind->residual_unit));
    PutWords(&entry, "components",
             {s.kind->components.begin(), s.kind->components.end()});
    Put(&entry, "normalized_rms", s.normalized_rms);
    if (s.kind->standing || s.kind->generated || !s.kind->configured) {
      entry["supposed"] = true;
    }
  }
  return json;
}

const char* VerdictName(ConstantEstimate::Verdict verdict) {
  switch (verdict) {
    case ConstantEstimate::Verdict::kObserved:
      return "observed";
    case ConstantEstimate::Verdict::kWeak:
      return "weak";
    case ConstantEstimate::Verdict::kUnobserved:
      return "unobserved";
  }
  return "";
}

Json ConstantsJson(const std::vector<ConstantEstimate>& constants) {
  Json json = Json::object();
  for (const ConstantEstimate& c : constants) {
    Json& entry = json[c.name];
    Put(&entry, "value", c.value);
    Put(&entry, "sigma", c.sigma);
    entry["unit"] = c.unit;
    Put(&entry, "prior_value", c.prior_value);
    Put(&entry, "prior_sigma", c.prior_sigma);
    if (c.widened > 1.0) Put(&entry, "sigma_widened_by", c.widened);
    entry["verdict"] = VerdictName(c.verdict);
    PutText(&entry, "advice", c.advice);
  }
  return json;
}

/// Of the errors of constants, a row each.
Json CorrelationsJson(const Eigen::MatrixXd& P) {
  const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < P.cols(); ++j) {
      row.push_back(i == j ? 1.0 : scale(i) * P(i, j) * scale(j));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json ObserverJson(const ObserverFigures& figures) {
  Json json;
  if (figures.gamma > 0.0) {
    Put(&json, "gamma_sqrt_s", figures.gamma);
  } else {
    Put(&json, "alpha_per_s", figures.alpha);
    Put(&json, "delta_per_s", figures.delta);
  }
  json["steps"] = figures.steps;
  json["back_offs"] = figures.back_offs;
  Put(&json, "least_information", figures.least_information);
  return json;
}

Json EvidenceJson(const Evidence& e) {
  Json json;
  json["rule"] = e.rule;
  json["grade"] = GradeName(e.grade);
  json["what"] = e.what;
  Put(&json, "value", e.value);
  Put(&json, "limit", e.limit);
  PutText(&json, "unit", e.unit);
  if (e.t_begin) json["span_s"] = {*e.t_begin, e.t_end.value_or(*e.t_begin)};
  if (!e.causes.empty()) json["likely_causes"] = e.causes;
  const std::vector<std::string> words = WhatToTry(e);
  if (!words.empty()) json["what_to_try"] = words;
  return json;
}

Json BroadJson(const BroadMetric& metric) {
  Json json;
  Put(&json, "total_rmse_deg", metric.rms.total / kDegree);
  Put(&json, "heading_rmse_deg", metric.rms.heading / kDegree);
  Put(&json, "inclination_rmse_deg", metric.rms.inclination / kDegree);
  json["count"] = metric.count;
  return json;
}

Json RivalJson(const RivalSolution& rival) {
  Json json;
  json["description"] = rival.description;
  Put(&json, "probability", rival.probability);
  Put(&json, "log_evidence", rival.log_evidence);
  json["differences"] = Json::array();
  for (const RivalSolution::Difference& difference : rival.differences) {
    Json entry;
    entry["quantity"] = difference.quantity;
    Put(&entry, "value", difference.value);
    entry["unit"] = difference.unit;
    json["differences"].push_back(std::move(entry));
  }
  return json;
}

void PutUnobserved(const std::vector<UnobservedSpan>& spans, Json* json) {
  for (const UnobservedSpan& span : spans) {
    Json entry;
    entry["component"] = span.component;
    Put(&entry, "t_begin_s", span.t_begin);
    Put(&entry, "t_end_s", span.t_end);
    Put(&entry, "sigma", span.sigma);
    (*json)["unobserved"].push_back(std::move(entry));
  }
}

Json InputJson(const FileDigest& input) {
  Json json = {
      {"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}};
  if (input.files != 1) json["files"] = input.files;
  return json;
}

Json FixesJson(const FixSummary& fixes) {
  Json json = {{"count", fixes.count}};
  Put(&json, "satellites_mean", fixes.satellites);
  for (const auto& [quality, count] : fixes.by_quality) {
    json["quality_percent"][std::to_string(quality)] =
        100.0 * static_cast<double>(count) / static_cast<double>(fixes.count);
  }
  return json;
}

Json MethodJson(const MethodSummary& m) {
  Json json;
  Put(&json, "seconds", m.seconds);
  Put(&json, "peak_rss_mb", m.peak_rss_mb);
  json["converged"] = m.converged;
  if (m.iterations > 0) json["iterations"] = m.iterations;
  Put(&json, "duration_s", m.duration);
  Put(&json, "distance_m", m.distance);
  PutWords(&json, "found", m.found);
  json["grade"] = GradeName(m.grade);
  PutText(&json, "verdict", m.verdict);
  json["evidence"] = Json::array();
  for (const Evidence& e : m.evidence) {
    json["evidence"].push_back(EvidenceJson(e));
  }
  PutText(&json, "contradicts_truth", m.contradiction);
  if (m.error) json["error"] = ErrorJson(*m.error);
  if (m.broad) json["broad"] = BroadJson(*m.broad);
  if (m.field_disturbed) {
    Put(&json, "field_disturbed_percent", 100.0 * *m.field_disturbed);
  }
  if (!m.outages.empty()) json["withheld"] = WithheldJson(m);
  if (m.error) {
    Json nees = NeesJson(*m.error);
    if (!nees.empty()) json["nees"] = std::move(nees);
  }
  json["residuals"] = ResidualsJson(m.residuals);
  json["constants"] = ConstantsJson(m.constants);
  if (m.constant_covariance.size() > 0 && m.constant_covariance.allFinite()) {
    json["constant_correlations"] = CorrelationsJson(m.constant_covariance);
  }
  for (const MountingSummary& mounting : m.mountings) {
    Json& entry = json["mountings"][mounting.sensor];
    Put(&entry, "roll_deg", mounting.euler.x() / kDegree);
    Put(&entry, "pitch_deg", mounting.euler.y() / kDegree);
    Put(&entry, "yaw_deg", mounting.euler.z() / kDegree);
  }
  PutUnobserved(m.unobserved, &json);
  for (const RivalSolution& rival : m.rivals) {
    json["rivals"].push_back(RivalJson(rival));
  }
  if (m.observer) json["observer"] = ObserverJson(*m.observer);
  return json;
}

void PutSpans(Json* json, const std::string& key,
              const std::vector<StreamSpan>& spans) {
  for (const StreamSpan& span : spans) {
    Json entry;
    PutText(&entry, "stream", span.stream);
    Put(&entry, "t_begin_s", span.t_begin);
    Put(&entry, "t_end_s", span.t_end);
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
  Put(&json, "t_s", start.t);
  PutText(&json, "position", start.position);
  PutText(&json, "attitude", start.attitude);
  PutText(&json, "heading", start.heading);
  PutText(&json, "alignment", start.alignment);
  PutText(&json, "why", start.why);
  Put(&json, "position_sigma_m", start.position_sigma);
  Put(&json, "velocity_sigma_mps", start.velocity_sigma);
  Put(&json, "attitude_sigma_deg",
      Eigen::Vector3d(start.attitude_sigma / kDegree));
  return json;
}

}  // namespace

void PutTruthFigures(const TrajectoryStatistics& statistics,
                     const std::string& contradiction,
                     nlohmann::ordered_json* method) {
  for (const char* key : {"contradicts_truth", "error", "nees"}) {
    method->erase(key);
  }
  PutText(method, "contradicts_truth", contradiction);
  (*method)["error"] = ErrorJson(statistics);
  Json nees = NeesJson(statistics);
  if (!nees.empty()) (*method)["nees"] = std::move(nees);
}

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
