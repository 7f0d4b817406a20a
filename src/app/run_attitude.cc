#include "app/run_attitude.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "app/command.h"
#include "app/result_folder.h"
#include "app/run_output.h"
#include "app/run_report.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "evaluation/broad_metric.h"
#include "io/config.h"
#include "io/solution_csv.h"
#include "io/summary.h"
#include "io/table.h"
#include "io/tum.h"

namespace hindsight {
namespace {

Dataset Load(const RunRequest& request, ResultFolder* folder) {
  ResolvedConfig resolved;
  Dataset dataset =
      LoadDataset(request.config, {.data_root = request.data_root}, &resolved);
  if (!request.ahrs_rule.empty()) dataset.ahrs.rule = request.ahrs_rule;
  WriteResolvedConfig(resolved, folder->Path("config.resolved.yaml"));
  return dataset;
}

std::vector<double> UniformTimes(const Solution& solution, double rate) {
  std::vector<double> times;
  const double end = std::floor(solution.states.back().t * rate);
  for (double k = std::ceil(solution.states.front().t * rate); k <= end; ++k) {
    times.push_back(k / rate);
  }
  return times;
}

void WriteFiles(const RunRequest& request, const Dataset& dataset,
                const Solution& solution, ResultFolder* folder) {
  const auto sample = [&](const std::vector<double>& times) {
    if (times.front() < solution.states.front().t ||
        times.back() > solution.states.back().t + 1.0) {
      throw InputError("--at: the times are not inside the solution");
    }
    return TableFromSolution(SampleAttitude(solution, dataset.imu, times));
  };
  const SolutionTable table =
      request.rate ? sample(UniformTimes(solution, *request.rate))
                   : TableFromSolution(solution);
  WriteSolutionCsv(folder->Path(solution.method + ".csv"), table, kProgram,
                   dataset.epoch_gps_ns);
  if (!request.at.empty()) {
    WriteSolutionCsv(folder->Path(solution.method + ".at.csv"),
                     sample(request.at), kProgram, dataset.epoch_gps_ns);
  }
}

double Share(const std::vector<signed char>& magnetic, int verdict) {
  const auto readings = std::count_if(magnetic.begin(), magnetic.end(),
                                      [](signed char v) { return v != 0; });
  if (readings == 0) return 0.0;
  return static_cast<double>(
             std::count(magnetic.begin(), magnetic.end(), verdict)) /
         static_cast<double>(readings);
}

/// One line a method.
void AddRow(const MethodSummary& summary, const Solution& solution,
            ReportTable* table) {
  std::vector<std::string> row = {solution.method};
  if (summary.error) {
    const BroadError e = summary.broad.value_or(BroadMetric()).rms;
    for (const double angle : {e.total, e.heading, e.inclination}) {
      row.push_back(summary.broad ? Format("%.3f", angle / kDegree) : "");
    }
  }
  row.push_back(solution.magnetic.empty()
                    ? ""
                    : Format("%.1f", 100.0 * Share(solution.magnetic, -1)));
  row.push_back(Format("%.3f", solution.seconds));
  row.emplace_back(GradeName(solution.grade));
  table->AddRow(row);
}

ReportTable EmptyTable(const Dataset& dataset) {
  std::vector<std::string> heading = {"method"};
  if (!dataset.truth.empty()) {
    heading.insert(heading.end(), {"total\nRMSE [deg]", "heading\nRMSE [deg]",
                                   "inclination\nRMSE [deg]"});
  }
  heading.insert(heading.end(), {"field\ndisturbed [%]", "time\n[s]", "grade"});
  return ReportTable(heading);
}

MethodSummary SummaryOf(const Dataset& dataset, const Solution& solution) {
  const SolutionTable table = TableFromSolution(solution);
  MethodSummary summary = SummarizeMethod(dataset, solution, table);
  const BroadMetric broad = EvaluateBroad(table, dataset.truth);
  if (broad.count > 0) summary.broad = broad;
  return summary;
}

int EstimateInto(const RunRequest& request, ResultFolder* folder) {
  Progress progress(request.progress);
  progress.Update("reading", 0.0);
  const Dataset dataset = Load(request, folder);
  AttitudeOptions options;
  options.from = request.from;
  options.to = request.to;
  options.progress = [&](const std::string& stage, double fraction) {
    progress.Update(stage, fraction);
  };
  AttitudeEstimation estimation(dataset, options);
  RunSummary summary = {.program = kProgram,
                        .dataset = dataset.name,
                        .epoch_gps_ns = dataset.epoch_gps_ns,
                        .start = {},
                        .policies = dataset.policies,
                        .notes = dataset.notes,
                        .best = "",
                        .methods = {}};
  ReportTable table = EmptyTable(dataset);
  std::vector<Solution> verdicts;
  for (const std::string& method : request.methods) {
    const Solution solution = estimation.Run(method);
    WriteFiles(request, dataset, solution, folder);
    summary.methods.push_back(SummaryOf(dataset, solution));
    AddRow(summary.methods.back(), solution, &table);
    Solution verdict;
    verdict.method = solution.method;
    verdict.grade = solution.grade;
    verdict.evidence = solution.evidence;
    verdict.verdict = solution.verdict;
    verdicts.push_back(std::move(verdict));
    folder->Keep(kSummaryName, SummaryText(summary));
  }
  const Solution& best = Best(verdicts);
  NameBest(best, verdicts, &summary);
  progress.Clear();
  summary.complete = true;
  if (request.report) WriteReport(request, summary, folder);
  folder->Commit(kSummaryName, SummaryText(summary));
  std::cout << DescribeNotes(dataset) << "\n"
            << table.Render() << DescribeEvidence(verdicts)
            << DescribeContradictions(summary) << "\nresults in " << request.out
            << "\n"
            << DescribeReport(request) << DescribeVerdict(best);
  return StatusOf(best.grade);
}

}  // namespace

int EstimateAttitude(const RunRequest& request) {
  return WithResultFolder(
      OutputOf(request), [&] { return InputsOf(request); },
      [&](ResultFolder* folder) { return EstimateInto(request, folder); });
}

}  // namespace hindsight
