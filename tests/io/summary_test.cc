#include "io/write/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/units.h"
#include "evaluation/truth_comparison.h"
#include "io/write/comparison.h"
#include "measurements/sensor_kind.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> Keys(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

NavigationPrior UnitPrior() {
  NavigationPrior prior;
  prior.position_sigma.setOnes();
  return prior;
}

MethodSummary SummaryOf(const Dataset& dataset, const Solution& solution) {
  std::optional<TrajectoryStatistics> error;
  if (!dataset.truth.empty()) {
    error = CompareWithTruth(TableFromSolution(solution), dataset.truth,
                             {.truth_sigma = dataset.truth_sigma})
                .statistics;
  }
  return SummarizeMethod(dataset, solution, error);
}

/// Driving north at 10 m/s for 40 s.
Solution Drive(const std::string& method) {
  Solution solution;
  solution.method = method;
  solution.layout = NavigationLayout(UnitPrior());
  Eigen::Vector3d p_e = EcefFromGeodetic({0.5, 0.1, 20.0});
  for (int k = 0; k <= 40; ++k) {
    State x;
    x.t = k;
    x.p_e = p_e;
    x.v_e = x.C_en() * Eigen::Vector3d(10.0, 0.0, 0.0);
    x.q_eb = Eigen::Quaterniond(x.C_en());
    solution.states.push_back(x);
    p_e += x.v_e;
  }
  const int dim = solution.layout.dim();
  solution.covariances = CovarianceSeries(dim, solution.states.size());
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    solution.covariances.Set(k, 4.0 * ErrorMatrix::Identity(dim, dim));
  }
  solution.seconds = 0.25;
  solution.grade = Grade::kDoubtful;
  solution.verdict = "doubtful: see there";
  solution.evidence = {{.rule = "residuals",
                        .grade = Grade::kDoubtful,
                        .what = "residuals of gnss are large",
                        .value = 7.0,
                        .limit = 5.0,
                        .unit = "sigma",
                        .t_begin = 3.0,
                        .t_end = 9.0,
                        .causes = {"a wrong clock"},
                        .remedies = {"a larger sigma"},
                        .better_methods = {"iterated", "batch"}},
                       {.rule = "accuracy", .what = "heading to 19 deg"}};
  return solution;
}

ResidualRecord Residual(double t, const Eigen::Vector3d& residual,
                        bool withheld) {
  ResidualRecord record;
  record.t = t;
  record.residual = residual;
  record.withheld = withheld;
  record.nis = 3.0;
  return record;
}

/// The truth runs 2 m east of the solution and heads 1 deg further right.
Dataset WithTruth(const Solution& solution) {
  Dataset dataset;
  dataset.name = "drive";
  dataset.streams.resize(1);
  dataset.streams[0].sensor.name = "gnss";
  for (const State& x : solution.states) {
    TruthPoint truth;
    truth.t = x.t;
    truth.p_e = x.p_e + x.C_en() * Eigen::Vector3d(0.0, 2.0, 0.0);
    truth.v_n = Eigen::Vector3d(10.0, 0.5, 0.0);
    truth.q_nb = QuaternionFromEuler(0.0, 0.0, 1.0 * kDegree);
    dataset.truth.push_back(truth);
  }
  return dataset;
}

RunSummary FullSummary() {
  Solution solution = Drive("batch");
  Dataset dataset = WithTruth(solution);
  dataset.outages = {{0, 10.0, 20.0}};
  solution.iterations = 4;
  solution.residuals = {Residual(5.0, {0.0, 0.0, 0.0}, false),
                        Residual(15.0, {3.0, 4.0, 12.0}, true)};
  ConstantEstimate scale;
  scale.name = "odometer_scale";
  scale.unit = "1";
  scale.value = 0.01;
  scale.sigma = 0.001;
  scale.prior_sigma = 0.1;
  solution.constants = {scale};
  solution.unobserved = {{"attitude[down]", 0.0, 12.0, 0.5}};
  RunSummary summary;
  summary.program = "hindsight 0";
  summary.dataset = dataset.name;
  StartSummary start;
  start.heading = "given";
  start.attitude_sigma.z() = 2.0 * kDegree;
  summary.start = start;
  summary.policies = {{"truth", "absent values skipped", 3}};
  summary.methods = {SummaryOf(dataset, solution)};
  summary.methods[0].peak_rss_mb = 80.0;
  summary.best = "batch";
  return summary;
}

TEST(Summary, HasTheDocumentedKeys) {
  const Json json = SummaryJson(FullSummary());
  EXPECT_THAT(Keys(json),
              ElementsAre("program", "dataset", "complete", "datum", "start",
                          "policies", "best", "grade", "methods"));
  const Json& batch = json["methods"]["batch"];
  EXPECT_THAT(Keys(batch),
              ElementsAre("seconds", "peak_rss_mb", "converged", "iterations",
                          "duration_s", "distance_m", "grade", "verdict",
                          "evidence", "error", "withheld", "nees", "residuals",
                          "constants", "unobserved"));
  EXPECT_THAT(
      Keys(batch["error"]),
      ElementsAre("position_rms_m", "position_max_m", "horizontal_rms_m",
                  "horizontal_max_m", "total_rms_m", "total_max_m",
                  "end_horizontal_m", "distance_m", "velocity_rms_mps",
                  "velocity_max_mps", "attitude_rms_deg", "attitude_max_deg",
                  "tilt_rms_deg", "matched_percent"));
  EXPECT_THAT(Keys(batch["withheld"]),
              ElementsAre("horizontal_rms_m", "horizontal_max_m", "total_rms_m",
                          "total_max_m", "outages"));
  EXPECT_THAT(Keys(batch["withheld"]["outages"][0]),
              ElementsAre("sensor", "t_begin_s", "t_end_s", "count",
                          "horizontal_rms_m", "horizontal_max_m", "total_rms_m",
                          "total_max_m", "distance_m", "drift_percent"));
}

TEST(Summary, MatchesHandComputedFigures) {
  const Json json = SummaryJson(FullSummary());
  const Json& batch = json["methods"]["batch"];
  const Json& error = batch["error"];
  EXPECT_NEAR(error["position_rms_m"][0].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(error["position_rms_m"][1].get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(error["horizontal_max_m"].get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(error["velocity_rms_mps"][1].get<double>(), 0.5, 1e-5);
  EXPECT_NEAR(error["attitude_rms_deg"][2].get<double>(), 1.0, 1e-4);
  EXPECT_DOUBLE_EQ(error["matched_percent"].get<double>(), 100.0);
  EXPECT_NEAR(batch["nees"]["position"].get<double>(), 1.0, 1e-6);
  const Json& outage = batch["withheld"]["outages"][0];
  EXPECT_EQ(outage["sensor"], "gnss");
  EXPECT_DOUBLE_EQ(outage["horizontal_max_m"].get<double>(), 5.0);
  EXPECT_DOUBLE_EQ(outage["total_max_m"].get<double>(), 13.0);
  EXPECT_NEAR(outage["distance_m"].get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(outage["drift_percent"].get<double>(), 5.0, 1e-9);
  const Json& gnss = batch["residuals"]["gnss"];
  EXPECT_EQ(gnss["count"], 1);
  EXPECT_EQ(gnss["withheld"], 1);
  EXPECT_DOUBLE_EQ(gnss["normalized_rms"].get<double>(), 1.0);
  const Json& scale = batch["constants"]["odometer_scale"];
  EXPECT_EQ(scale["unit"], "1");
  EXPECT_EQ(scale["verdict"], "observed");
  EXPECT_DOUBLE_EQ(json["start"]["attitude_sigma_deg"][2].get<double>(), 2.0);
}

TEST(Summary, HoldsTheGradeAndItsEvidence) {
  const Json json = SummaryJson(FullSummary());
  EXPECT_EQ(json["best"], "batch");
  EXPECT_EQ(json["grade"], "doubtful");
  const Json& batch = json["methods"]["batch"];
  EXPECT_EQ(batch["grade"], "doubtful");
  ASSERT_EQ(batch["evidence"].size(), 2u);
  const Json expected = {
      {"rule", "residuals"},
      {"grade", "doubtful"},
      {"what", "residuals of gnss are large"},
      {"value", 7.0},
      {"limit", 5.0},
      {"unit", "sigma"},
      {"span_s", {3.0, 9.0}},
      {"likely_causes", {"a wrong clock"}},
      {"what_to_try", {"method iterated or batch", "a larger sigma"}}};
  EXPECT_EQ(batch["evidence"][0], expected);
  EXPECT_THAT(Keys(batch["evidence"][1]), ElementsAre("rule", "grade", "what"));
  // A NEES of one contradicts nothing.
  EXPECT_FALSE(batch.contains("contradicts_truth"));
}

TEST(Summary, WhatTheTruthContradictsStandsBesideTheGrade) {
  Solution solution = Drive("batch");
  const Dataset dataset = WithTruth(solution);
  const int dim = solution.layout.dim();
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    solution.covariances.Set(k, 1e-2 * ErrorMatrix::Identity(dim, dim));
  }
  const MethodSummary m = SummaryOf(dataset, solution);
  RunSummary summary;
  summary.methods = {m};
  const Json batch = SummaryJson(summary)["methods"]["batch"];
  EXPECT_EQ(batch["grade"], "doubtful");
  // 2 m off at a sigma of 0.1 m.
  EXPECT_THAT(batch["contradicts_truth"].get<std::string>(),
              HasSubstr("mean NEES of position 400, where 3 is right"));
}

TEST(Summary, HasEpochAndBroadFiguresWhereTheyExist) {
  RunSummary summary = FullSummary();
  summary.epoch_gps_ns = (2374LL * 604800 + 243261) * 1'000'000'000;
  BroadMetric broad;
  broad.rms = {3.0 * kDegree, 2.0 * kDegree, 1.0 * kDegree};
  broad.count = 7;
  summary.methods[0].broad = broad;
  const Json json = SummaryJson(summary);
  EXPECT_EQ(json["epoch"]["gps_week"], 2374);
  EXPECT_EQ(json["epoch"]["gps_second"], 243261.0);
  EXPECT_EQ(json["epoch"]["utc"], "2025-07-08T19:34:03.000Z");
  const Json& figures = json["methods"]["batch"]["broad"];
  EXPECT_NEAR(figures["total_rmse_deg"].get<double>(), 3.0, 1e-12);
  EXPECT_NEAR(figures["heading_rmse_deg"].get<double>(), 2.0, 1e-12);
  EXPECT_NEAR(figures["inclination_rmse_deg"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(figures["count"], 7);
}

TEST(Summary, LeavesOutFiguresThatDoNotExist) {
  Solution solution = Drive("ekf");
  solution.covariances = CovarianceSeries();
  Dataset dataset;
  dataset.streams.resize(1);
  dataset.streams[0].sensor.name = "gnss";
  RunSummary summary;
  summary.methods = {SummaryOf(dataset, solution)};
  summary.methods[0].seconds = std::numeric_limits<double>::quiet_NaN();
  const Json json = SummaryJson(summary);
  EXPECT_THAT(Keys(json),
              ElementsAre("program", "dataset", "complete", "methods"));
  EXPECT_THAT(Keys(json["methods"]["ekf"]),
              ElementsAre("converged", "duration_s", "distance_m", "grade",
                          "verdict", "evidence", "residuals", "constants"));
  EXPECT_THAT(json.dump(), Not(HasSubstr("null")));
}

TEST(Summary, IsWrittenAsReadableJson) {
  RunSummary summary = FullSummary();
  EXPECT_EQ(Json::parse(SummaryText(summary)), SummaryJson(summary));
  EXPECT_EQ(SummaryJson(summary)["complete"], false);
  summary.complete = true;
  EXPECT_EQ(SummaryJson(summary)["complete"], true);
}

TEST(ComparisonTable, HasARowForEachMethodAndNoEmptyColumns) {
  RunSummary summary = FullSummary();
  const std::string with_truth = ComparisonTable(summary);
  EXPECT_THAT(with_truth, HasSubstr("\nbatch "));
  EXPECT_THAT(with_truth, HasSubstr("NEES"));
  EXPECT_THAT(with_truth, HasSubstr(" 5.000 "));
  summary.methods[0].error.reset();
  const std::string without = ComparisonTable(summary);
  EXPECT_THAT(without, Not(HasSubstr("NEES")));
  EXPECT_THAT(without, Not(HasSubstr("truth")));
  EXPECT_THAT(without, Not(HasSubstr(" \n")));
}

TEST(ResidualOverview, HasARowForEachSensor) {
  RunSummary summary = FullSummary();
  summary.best = "batch";
  const std::string text = ResidualOverview(summary);
  EXPECT_THAT(text, HasSubstr("over sigma, rms  measured  rejected"));
  EXPECT_THAT(text, HasSubstr("\ngnss "));
  summary.methods[0].residuals.clear();
  EXPECT_EQ(ResidualOverview(summary), "");
}

TEST(Summary, SaysWhatTheReceiverSaidAndWhatWasRead) {
  RunSummary summary = FullSummary();
  Dataset dataset;
  dataset.streams.resize(1);
  dataset.streams[0].sensor.name = "gnss";
  dataset.streams[0].sensor.kind = &PositionKind();
  for (const double quality : {1.0, 1.0, 1.0, 2.0}) {
    PositionFix fix;
    fix.quality = quality;
    fix.satellites = 6.0 + quality;
    dataset.streams[0].measurements.push_back({0.0, 0, false, fix});
  }
  summary.fixes = SummarizeFixes(dataset);
  summary.inputs = {{"imu.csv", 12, "ab"}, {"oxts", 30, "cd", 3}};
  const Json json = SummaryJson(summary);
  EXPECT_EQ(json["fixes"]["gnss"]["count"], 4);
  EXPECT_EQ(json["fixes"]["gnss"]["quality_percent"]["1"], 75.0);
  EXPECT_EQ(json["fixes"]["gnss"]["quality_percent"]["2"], 25.0);
  EXPECT_EQ(json["fixes"]["gnss"]["satellites_mean"], 7.25);
  EXPECT_EQ(json["inputs"][0]["path"], "imu.csv");
  EXPECT_EQ(json["inputs"][0]["bytes"], 12);
  EXPECT_FALSE(json["inputs"][0].contains("files"));
  EXPECT_EQ(json["inputs"][1]["files"], 3);
  EXPECT_EQ(json["datum"], "WGS-84, heights above the ellipsoid");
}

TEST(ErrorTable, ListsEveryComponentAndTheMatchedPart) {
  const Solution solution = Drive("batch");
  const Dataset dataset = WithTruth(solution);
  const std::string text = ErrorTable(
      EvaluateTrajectory(TableFromSolution(solution), dataset.truth, {}));
  EXPECT_THAT(text, HasSubstr("position horizontal [m]"));
  EXPECT_THAT(text, HasSubstr("velocity down [m/s]"));
  EXPECT_THAT(text, HasSubstr("heading [deg]"));
  EXPECT_THAT(text, HasSubstr("matched: 41 of 41 truth points (100.00 %)"));
  EXPECT_THAT(text, HasSubstr("mean NEES position (3 if consistent): 1.000"));
}

TEST(TruthTimes, AreThoseOfTheSpan) {
  TruthSeries truth;
  for (const double t : {0.0, 1.0, 1.5, 2.0, 2.5}) {
    TruthPoint point;
    point.t = t;
    truth.push_back(point);
  }
  EXPECT_EQ(TruthTimes(truth, 0.5, 2.0), (std::vector<double>{1.0, 1.5, 2.0}));
}

}  // namespace
}  // namespace hindsight
