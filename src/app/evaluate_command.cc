#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/flags.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "evaluation/broad_metric.h"
#include "evaluation/trajectory_error.h"
#include "io/comparison.h"
#include "io/config.h"
#include "io/solution_csv.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Compares the trajectory SOLUTION with the reference TRUTH, both files in
hindsight's CSV format (a result of 'run', or a data set's truth.csv). The
solution is interpolated to the times of the truth. Errors are truth minus
solution; normalised errors (mean of e' P^-1 e of three components, expected
3) where the solution holds covariances. --metric=broad gives the attitude errors of the BROAD benchmark: total, heading
and inclination, root mean square in motion; there TRUTH may also be a
configuration (.yaml) whose truth is meant.
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

void PrintJson(const TrajectoryStatistics& all) {
  nlohmann::ordered_json json = {{"truth_count", all.truth_count},
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
  const std::string contradiction = Contradiction(all);
  if (!contradiction.empty()) json["contradicts_truth"] = contradiction;
  std::cout << json.dump(2) << "\n";
}

std::vector<TruthPoint> ReadTruthOf(const std::string& path) {
  if (!path.ends_with(".yaml")) return TruthFromTable(ReadSolutionCsv(path));
  return LoadDataset(path, {.data_root = FLAGS_data_root}).truth;
}

int PrintBroad(const std::string& solution_path,
               const std::string& truth_path) {
  const BroadMetric metric =
      EvaluateBroad(ReadSolutionCsv(solution_path), ReadTruthOf(truth_path));
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
    std::cout << Format(
        "RMSE [deg]: total %.3f, heading %.3f, inclination %.3f (%zu points "
        "in motion)\n",
        metric.rms.total / kDegree, metric.rms.heading / kDegree,
        metric.rms.inclination / kDegree, metric.count);
  }
  return kUsable;
}

int Run(const std::vector<std::string>& arguments) {
  if (FLAGS_metric == "broad") return PrintBroad(arguments[0], arguments[1]);
  if (FLAGS_metric != "trajectory") {
    throw UsageError("--metric=" + FLAGS_metric +
                     ": expected trajectory or broad");
  }
  const SolutionTable solution = ReadSolutionCsv(arguments[0]);
  const SolutionTable truth = ReadSolutionCsv(arguments[1]);
  const TrajectoryErrorOptions options;
  const TrajectoryStatistics statistics = EvaluateTrajectory(
      solution,
      IsSparser(solution, truth) ? TruthAt(truth, solution.t, options.max_gap)
                                 : TruthFromTable(truth),
      options);
  if (statistics.matched_count == 0) {
    throw InputError(
        arguments[0], 0,
        Format("nothing to compare with %s: the solution covers %.3f s to "
               "%.3f s, the truth %.3f s to %.3f s",
               arguments[1].c_str(), solution.t.front(), solution.t.back(),
               truth.t.front(), truth.t.back()));
  }
  if (FLAGS_json) {
    PrintJson(statistics);
  } else {
    std::cout << ErrorTable(statistics);
    const std::string contradiction = Contradiction(statistics);
    if (!contradiction.empty()) {
      std::cout << arguments[0] << ": " << contradiction << "\n";
    }
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
      .flags = {{"json", "", "print the figures as one JSON object"},
                {"metric", "NAME", "trajectory or broad (trajectory)"},
                {"data_root", "DIR",
                 "where a relative folder of a configuration is looked for\n"
                 "(../shared/data)"}},
      .min_arguments = 2,
      .max_arguments = 2,
      .run = Run,
  };
}

}  // namespace hindsight
