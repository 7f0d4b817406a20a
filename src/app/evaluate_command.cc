#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/command.h"
#include "app/file_place.h"
#include "app/flags.h"
#include "app/method_output.h"
#include "app/report_page.h"
#include "app/run_output.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/units.h"
#include "evaluation/broad_metric.h"
#include "evaluation/truth_comparison.h"
#include "io/config/config.h"
#include "io/read/npz.h"
#include "io/write/atomic_file.h"
#include "io/write/comparison.h"
#include "io/write/error_csv.h"
#include "io/write/solution_csv.h"
#include "io/write/summary.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Compares the trajectory SOLUTION with the reference TRUTH: SOLUTION a file in
hindsight's CSV format or its arrays (.npz), a result of 'run' above all; TRUTH
such a file, a data set's truth.csv or a configuration (.yaml) whose truth is
meant.

Errors are truth minus solution, at the truth's times (points closer than 0.1 s
to the one before are left out), just as 'run' prints them. For a METHOD.csv or
METHOD.npz of 'run' the rows at these times stand in METHOD.truth.csv beside it,
which is used if it fits TRUTH. Without it a solution sparser than the truth is
compared at its own rows, to which the truth is interpolated, and any other is
interpolated to the truth's times; the last lines say which.

With --out=FILE it writes the page of 'report' as well, of this solution and
these errors; of a METHOD.csv or METHOD.npz of 'run' with all that its folder
tells of it.

Normalised errors (mean of e' P^-1 e of three components, expected 3) where the
solution holds covariances. --metric=broad gives the attitude errors of the
BROAD benchmark: total, heading and inclination, root mean square in motion.
)";

/// Statistics under one key; `scale` turns SI into `unit`.
struct Row {
  std::string key;
  std::string unit;
  double scale;
  const ErrorStatistics* statistics;
};

std::vector<Row> Rows(const TrajectoryStatistics& all) {
  std::vector<Row> rows;
  const auto add_vector = [&](const std::string& key, const std::string& unit,
                              const VectorErrorStatistics& v) {
    rows.push_back({key + "_north", unit, 1.0, &v.axis[0]});
    rows.push_back({key + "_east", unit, 1.0, &v.axis[1]});
    rows.push_back({key + "_down", unit, 1.0, &v.axis[2]});
    rows.push_back({key + "_horizontal", unit, 1.0, &v.horizontal});
    rows.push_back({key + "_total", unit, 1.0, &v.total});
  };
  if (all.position) add_vector("position", "m", *all.position);
  if (all.velocity) add_vector("velocity", "m/s", *all.velocity);
  if (all.attitude) {
    const AttitudeErrorStatistics& a = *all.attitude;
    const double scale = 1.0 / kDegree;
    rows.push_back({"roll", "deg", scale, &a.axis[0]});
    rows.push_back({"pitch", "deg", scale, &a.axis[1]});
    rows.push_back({"heading", "deg", scale, &a.axis[2]});
    rows.push_back({"tilt", "deg", scale, &a.tilt});
    rows.push_back({"rotation", "deg", scale, &a.total});
  }
  return rows;
}

void PrintJson(const TrajectoryStatistics& all, const std::string& file) {
  nlohmann::ordered_json json = {
      {"solution", file},
      {"at", all.at_solution_rows ? "solution rows" : "truth points"},
      {"truth_count", all.truth_count},
      {"matched_count", all.matched_count},
      {"matched_percent", all.matched_percent()}};
  for (const Row& row : Rows(all)) {
    const ErrorStatistics& s = *row.statistics;
    json["errors"][row.key] = {
        {"unit", row.unit},           {"rms", row.scale * s.rms},
        {"mean", row.scale * s.mean}, {"std", row.scale * s.std},
        {"p50", row.scale * s.p50},   {"p68", row.scale * s.p68},
        {"p95", row.scale * s.p95},   {"p99", row.scale * s.p99},
        {"max", row.scale * s.max}};
  }
  if (all.position_nees) json["nees"]["position"] = *all.position_nees;
  if (all.velocity_nees) json["nees"]["velocity"] = *all.velocity_nees;
  if (all.attitude_nees) json["nees"]["attitude"] = *all.attitude_nees;
  if (all.attitude_inside) {
    json["nees"]["attitude_inside_3_sigma_percent"] =
        100.0 * *all.attitude_inside;
  }
  const std::string contradiction = Contradiction(all);
  if (!contradiction.empty()) json["contradicts_truth"] = contradiction;
  std::cout << json.dump(2) << "\n";
}

struct Reference {
  TruthSeries points;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  TruthSigma sigma = {};
};

Reference ReadReference(const std::string& path) {
  if (!path.ends_with(".yaml")) {
    return {.points = TruthFromTable(ReadSolutionTable(path))};
  }
  Dataset dataset = LoadDataset(path, {.data_root = FLAGS_data_root});
  if (dataset.truth.empty()) throw InputError(path + ": there is no truth");
  return {std::move(dataset.truth), dataset.truth_lever_arm_b,
          dataset.truth_sigma};
}

/// The file that is compared: METHOD.truth.csv in place of METHOD.csv or .npz if
/// it has the truth's times.
std::string ComparedFile(const std::string& path, const Reference& reference) {
  const std::filesystem::path file = path;
  const bool is_table = file.extension() == ".csv" || IsNpz(path);
  if (!is_table || path.ends_with(kTruthSuffix)) return path;
  const std::string sampled =
      (file.parent_path() / file.stem()).string() + kTruthSuffix;
  if (!std::filesystem::exists(sampled)) return path;
  TruthSeries thinned = reference.points;
  ThinTruth(&thinned);
  return HasRowsAtTruth(ReadSolutionTable(sampled), thinned) ? sampled : path;
}

int PrintBroad(const std::string& solution_path,
               const std::string& truth_path) {
  const BroadMetric metric = EvaluateBroad(ReadSolutionTable(solution_path),
                                           ReadReference(truth_path).points);
  if (metric.count == 0) {
    throw InputError(solution_path, 0,
                     "no attitude to compare with " + truth_path);
  }
  if (FLAGS_json) {
    const nlohmann::ordered_json json = {
        {"total_rmse_deg", metric.rms.total / kDegree},
        {"heading_rmse_deg", metric.rms.heading / kDegree},
        {"inclination_rmse_deg", metric.rms.inclination / kDegree},
        {"count", metric.count}};
    std::cout << json.dump(2) << "\n";
  } else {
    std::cout << fmt::format(
        "RMSE [deg]: total {:.3f}, heading {:.3f}, inclination {:.3f} ({} "
        "points "
        "in motion)\n",
        metric.rms.total / kDegree, metric.rms.heading / kDegree,
        metric.rms.inclination / kDegree, metric.count);
  }
  return kUsable;
}

/// The page of `report` with the errors of this comparison.
void WritePage(const std::string& path, const SolutionTable& compared,
               const TruthComparison& comparison) {
  CheckFilePlace(FLAGS_out, {"'report' or 'evaluate'", IsReportPage});
  EvaluatedSolution evaluated;
  evaluated.file = path;
  for (ErrorColumn& column : ColumnsOf(comparison.errors, compared)) {
    evaluated.errors[column.title] = std::move(column.values);
  }
  const TrajectoryStatistics& statistics = comparison.statistics;
  evaluated.figures = nlohmann::ordered_json::object();
  PutTruthFigures(statistics, Contradiction(statistics), &evaluated.figures);
  WriteFileAtomically(FLAGS_out, ReportPage(std::move(evaluated)));
}

int Run(const std::vector<std::string>& arguments) {
  if (FLAGS_metric == "broad" && !FLAGS_out.empty()) {
    throw UsageError("--out goes with --metric=trajectory");
  }
  if (FLAGS_metric == "broad") return PrintBroad(arguments[0], arguments[1]);
  if (FLAGS_metric != "trajectory") {
    throw UsageError("--metric=" + FLAGS_metric +
                     ": expected trajectory or broad");
  }
  const Reference truth = ReadReference(arguments[1]);
  const std::string file = ComparedFile(arguments[0], truth);
  const SolutionTable solution = ReadSolutionTable(file);
  TrajectoryErrorOptions options;
  options.truth_sigma = truth.sigma;
  // The rows at the truth's times are those of its point.
  if (file == arguments[0]) options.truth_lever_arm_b = truth.lever_arm_b;
  const TruthComparison comparison =
      CompareWithTruth(solution, truth.points, options);
  const TrajectoryStatistics& statistics = comparison.statistics;
  if (statistics.matched_count == 0) {
    throw InputError(
        arguments[0], 0,
        fmt::format(
            "nothing to compare with {}: the solution covers {:.3f} s to "
            "{:.3f} s, the truth {:.3f} s to {:.3f} s",
            arguments[1], solution.t.front(), solution.t.back(),
            truth.points.front().t, truth.points.back().t));
  }
  if (!FLAGS_out.empty()) {
    WritePage(arguments[0], solution, comparison);
  }
  if (FLAGS_json) {
    PrintJson(statistics, file);
  } else {
    std::cout << ErrorTable(statistics, StyleOfOutput()) << "compared: " << file
              << " with " << arguments[1] << "\n";
    const std::string contradiction = Contradiction(statistics);
    if (!contradiction.empty()) {
      std::cout << arguments[0] << ": " << contradiction << "\n";
    }
    if (!FLAGS_out.empty()) std::cout << "report in " << FLAGS_out << "\n";
  }
  return kUsable;
}

}  // namespace

Command EvaluateCommand() {
  return {
      .name = "evaluate",
      .summary = "compare a trajectory with a reference",
      .arguments = "SOLUTION TRUTH",
      .help = kHelp,
      .flags =
          {{"json", "", "print the figures as one JSON object"},
           {"metric", "NAME", "trajectory or broad (trajectory)"},
           {"out", "FILE", "write the page of 'report' there"},
           {"force", "", "replace FILE if it is such a page"},
           {"data_root", "DIR",
            "where a relative folder of a configuration is looked for, if\n"
            "not beside it"}},
      .min_arguments = 2,
      .max_arguments = 2,
      .run = Run,
  };
}

}  // namespace hindsight
