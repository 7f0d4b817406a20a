#include "io/write/method_json.h"

#include "base/units.h"
#include "io/write/json_put.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;

Eigen::Vector3d Rms(const std::array<ErrorStatistics, 3>& axis) {
  return {axis[0].rms, axis[1].rms, axis[2].rms};
}

Eigen::Vector3d Max(const std::array<ErrorStatistics, 3>& axis) {
  return {axis[0].max, axis[1].max, axis[2].max};
}

Json ErrorJson(const TrajectoryStatistics& s) {
  Json json = Json::object();
  if (s.position) {
    PutValue(&json, "position_rms_m", Rms(s.position->axis));
    PutValue(&json, "position_max_m", Max(s.position->axis));
    PutValue(&json, "horizontal_rms_m", s.position->horizontal.rms);
    PutValue(&json, "horizontal_max_m", s.position->horizontal.max);
    PutValue(&json, "total_rms_m", s.position->total.rms);
    PutValue(&json, "total_max_m", s.position->total.max);
    PutValue(&json, "end_horizontal_m", s.final_horizontal);
    PutValue(&json, "distance_m", s.distance);
  }
  if (s.velocity) {
    PutValue(&json, "velocity_rms_mps", Rms(s.velocity->axis));
    PutValue(&json, "velocity_max_mps", Max(s.velocity->axis));
  }
  if (s.attitude) {
    PutValue(&json, "attitude_rms_deg", Rms(s.attitude->axis) / kDegree);
    PutValue(&json, "attitude_max_deg", Max(s.attitude->axis) / kDegree);
    PutValue(&json, "tilt_rms_deg", s.attitude->tilt.rms / kDegree);
  }
  PutValue(&json, "matched_percent", s.matched_percent());
  return json;
}

void PutPrediction(const PredictionError& error, const std::string& prefix,
                   const std::string& unit, Json* json) {
  PutValue(json, prefix + "horizontal_rms_" + unit, error.horizontal_rms);
  PutValue(json, prefix + "horizontal_max_" + unit, error.horizontal_max);
  PutValue(json, prefix + "total_rms_" + unit, error.total_rms);
  PutValue(json, prefix + "total_max_" + unit, error.total_max);
}

Json OutageJson(const OutageError& outage, const std::string& sensor) {
  Json json;
  json["sensor"] = sensor;
  PutValue(&json, "t_begin_s", outage.outage.t_begin);
  PutValue(&json, "t_end_s", outage.outage.t_end);
  json["count"] = outage.count;
  const bool is_position = outage.kind->is_position;
  if (outage.error) {
    PutPrediction(*outage.error, "", is_position ? "m" : "mps", &json);
  }
  PutValue(&json, "distance_m", outage.distance);
  PutValue(&json, "drift_percent", outage.drift_percent);
  return json;
}

Json WithheldJson(const MethodSummary& m) {
  Json json = Json::object();
  if (const auto e = PoolOutageErrors(m.outages, PositionKind())) {
    PutPrediction(*e, "", "m", &json);
  }
  if (const auto e = PoolOutageErrors(m.outages, VelocityKind())) {
    PutValue(&json, "velocity_horizontal_rms_mps", e->horizontal_rms);
    PutValue(&json, "velocity_horizontal_max_mps", e->horizontal_max);
  }
  json["outages"] = Json::array();
  for (std::size_t i = 0; i < m.outages.size(); ++i) {
    json["outages"].push_back(OutageJson(m.outages[i], m.outage_sensors[i]));
  }
  return json;
}

Json NeesJson(const TrajectoryStatistics& s) {
  Json json;
  PutValue(&json, "position", s.position_nees);
  PutValue(&json, "velocity", s.velocity_nees);
  PutValue(&json, "attitude", s.attitude_nees);
  if (s.attitude_inside) {
    PutValue(&json, "attitude_inside_3_sigma_percent",
             100.0 * *s.attitude_inside);
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
    PutValue(&entry, "normalized_rms", s.normalized_rms);
    if (s.kind->standing || s.kind->generated || !s.kind->configured) {
      entry["supposed"] = true;
    }
  }
  return json;
}

Json ConstantsJson(const std::vector<ConstantEstimate>& constants) {
  Json json = Json::object();
  for (const ConstantEstimate& c : constants) {
    Json& entry = json[c.name];
    PutValue(&entry, "value", c.value);
    PutValue(&entry, "sigma", c.sigma);
    entry["unit"] = c.unit;
    PutValue(&entry, "prior_value", c.prior_value);
    PutValue(&entry, "prior_sigma", c.prior_sigma);
    if (c.widened > 1.0) PutValue(&entry, "sigma_widened_by", c.widened);
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
    PutValue(&json, "gamma_sqrt_s", figures.gamma);
  } else {
    PutValue(&json, "alpha_per_s", figures.alpha);
    PutValue(&json, "delta_per_s", figures.delta);
  }
  json["steps"] = figures.steps;
  json["back_offs"] = figures.back_offs;
  PutValue(&json, "least_information", figures.least_information);
  return json;
}

Json EvidenceJson(const Evidence& e) {
  Json json;
  json["rule"] = e.rule;
  json["grade"] = GradeName(e.grade);
  json["what"] = e.what;
  PutValue(&json, "value", e.value);
  PutValue(&json, "limit", e.limit);
  PutText(&json, "unit", e.unit);
  if (e.t_begin) json["span_s"] = {*e.t_begin, e.t_end.value_or(*e.t_begin)};
  if (!e.causes.empty()) json["likely_causes"] = e.causes;
  const std::vector<std::string> words = WhatToTry(e);
  if (!words.empty()) json["what_to_try"] = words;
  return json;
}

Json BroadJson(const BroadMetric& metric) {
  Json json;
  PutValue(&json, "total_rmse_deg", metric.rms.total / kDegree);
  PutValue(&json, "heading_rmse_deg", metric.rms.heading / kDegree);
  PutValue(&json, "inclination_rmse_deg", metric.rms.inclination / kDegree);
  json["count"] = metric.count;
  return json;
}

Json RivalJson(const RivalSolution& rival) {
  Json json;
  json["description"] = rival.description;
  PutValue(&json, "probability", rival.probability);
  PutValue(&json, "log_evidence", rival.log_evidence);
  json["differences"] = Json::array();
  for (const RivalSolution::Difference& difference : rival.differences) {
    Json entry;
    entry["quantity"] = difference.quantity;
    PutValue(&entry, "value", difference.value);
    entry["unit"] = difference.unit;
    json["differences"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace

void PutUnobserved(const std::vector<UnobservedSpan>& spans,
                   nlohmann::ordered_json* json) {
  for (const UnobservedSpan& span : spans) {
    Json entry;
    entry["component"] = span.component;
    PutValue(&entry, "t_begin_s", span.t_begin);
    PutValue(&entry, "t_end_s", span.t_end);
    PutValue(&entry, "sigma", span.sigma);
    (*json)["unobserved"].push_back(std::move(entry));
  }
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

nlohmann::ordered_json MethodJson(const MethodSummary& m) {
  Json json;
  PutValue(&json, "seconds", m.seconds);
  PutValue(&json, "peak_rss_mb", m.peak_rss_mb);
  json["converged"] = m.converged;
  if (m.iterations > 0) json["iterations"] = m.iterations;
  PutValue(&json, "duration_s", m.duration);
  PutValue(&json, "distance_m", m.distance);
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
    PutValue(&json, "field_disturbed_percent", 100.0 * *m.field_disturbed);
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
    PutValue(&entry, "roll_deg", mounting.euler.x() / kDegree);
    PutValue(&entry, "pitch_deg", mounting.euler.y() / kDegree);
    PutValue(&entry, "yaw_deg", mounting.euler.z() / kDegree);
  }
  PutUnobserved(m.unobserved, &json);
  for (const RivalSolution& rival : m.rivals) {
    json["rivals"].push_back(RivalJson(rival));
  }
  if (m.observer) json["observer"] = ObserverJson(*m.observer);
  return json;
}

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

}  // namespace hindsight
