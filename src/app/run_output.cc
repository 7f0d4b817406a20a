#include "app/run_output.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "app/method_output.h"
#include "app/report_page.h"
#include "app/wished_rows.h"
#include "base/error.h"
#include "dataset/injection.h"
#include "evaluation/broad_metric.h"
#include "evaluation/truth_comparison.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/constant_csv.h"
#include "io/write/error_csv.h"
#include "io/write/solution_csv.h"
#include "problems/method.h"

namespace hindsight {
namespace {

/// t[s] and the probability of each mode.
void WriteModes(const std::string& path, const Solution& solution,
                const Dataset& dataset) {
  std::string text = "# program: " + ProgramLine(dataset) + "\n" +
                     EpochComment(dataset.epoch_gps_ns) + "t[s]";
  for (const std::string& name : solution.modes->names) text += "," + name;
  text += "\n";
  for (std::size_t k = 0; k < solution.modes->probabilities.size(); ++k) {
    text += fmt::format("{:.6f}", solution.states[k].t);
    for (const double p : solution.modes->probabilities[k]) {
      text += fmt::format(",{:.6g}", p);
    }
    text += "\n";
  }
  WriteFileAtomically(path, text);
}

}  // namespace

const char* const kProgram = "hindsight " HINDSIGHT_VERSION;

std::string InjectionRemark(const Dataset& dataset) {
  std::string remark;
  for (const Injection& injection : dataset.injections) {
    remark += std::string(remark.empty() ? "" : "; ") +
              "error injected on purpose: " + Describe(injection);
  }
  return remark;
}

std::string ProgramLine(const Dataset& dataset) {
  const std::string remark = InjectionRemark(dataset);
  return kProgram + (remark.empty() ? "" : "; " + remark);
}

OutputRequest OutputOf(const RunRequest& request) {
  return {request.out, request.force, request.clean};
}

LoadOptions LoadOptionsOf(const RunRequest& request) {
  return {.data_root = request.data_root,
          .without = request.without,
          .constants = request.constants,
          .omit = request.omit};
}

ResultFolder::Paths InputsOf(const RunRequest& request) {
  ResultFolder::Paths inputs =
      ConfigInputs(request.config, LoadOptionsOf(request));
  if (!request.at_file.empty()) inputs.emplace_back(request.at_file);
  return inputs;
}

ResultFolder::Paths FilesReadBy(const RunRequest& request) {
  ResultFolder::Paths files =
      ConfigFilesRead(request.config, LoadOptionsOf(request));
  if (!request.at_file.empty()) files.emplace_back(request.at_file);
  return files;
}

double PeakRssMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void CheckTimesCovered(const RunRequest& request, const Solution& solution) {
  if (solution.states.empty()) return;
  const double begin = solution.states.front().t;
  const double end = solution.states.back().t;
  for (const double t : request.at) {
    if (t >= begin && t <= end) continue;
    throw InputError(
        fmt::format("--at: t = {:.6f} s is outside the reconstructed "
                    "interval from {:.6f} s to {:.6f} s",
                    t, begin, end));
  }
}

MethodTables SampleMethod(const RunRequest& request, const Dataset& dataset,
                          const Reconstruction& reconstruction,
                          const Solution& solution, MethodOutput* output) {
  MethodTables tables;
  if (solution.states.empty()) return tables;
  tables.reference = TruthOf(dataset, solution);
  const Eigen::Vector3d& truth_point_b = tables.reference.lever_arm_b;
  std::vector<double> truth_times;
  if (request.attitude_alone) {
    tables.truth = TableAt(Eigen::Vector3d::Zero(), dataset, solution);
  } else {
    truth_times = TruthTimes(tables.reference.points, solution.states.front().t,
                             solution.states.back().t);
  }
  if (!request.rate) {
    TakeNodes(request.point_b, dataset, solution,
              [output](const SolutionTable& piece) { output->Append(piece); });
  }
  const auto add = [](const SolutionTable& piece, SolutionTable* table) {
    if (piece.size() > 0) AppendTable(piece, table);
  };
  SampleRows(dataset, reconstruction, solution,
             {{Times(request.at), request.point_b},
              {Times(std::move(truth_times)), truth_point_b},
              {request.rate ? Times(solution, *request.rate)
                            : Times(std::vector<double>()),
               request.point_b}},
             [&](const std::vector<SolutionTable>& pieces) {
               const auto& [at, truth, rows] =
                   std::tie(pieces[0], pieces[1], pieces[2]);
               add(at, &tables.at);
               add(truth, &tables.truth);
               if (request.point_b == truth_point_b) {
                 output->Append(rows, truth);
               } else {
                 output->Append(rows);
                 output->AppendTruth(truth);
               }
             });
  return tables;
}

void CompareTables(const Dataset& dataset, MethodTables* tables) {
  if (dataset.truth.empty()) return;
  tables->comparison = CompareWithTruth(tables->truth, tables->reference.points,
                                        {.truth_sigma = dataset.truth_sigma});
}

namespace {

/// At the truth's own times, wherever the two are compared.
ErrorColumns ErrorsAtTruth(const Dataset& dataset, const MethodTables& tables) {
  if (!tables.comparison->truth.at_solution_rows) {
    return ColumnsOf(tables.comparison->errors, tables.truth);
  }
  TruthSeries truth = tables.reference.points;
  ThinTruth(&truth);
  return ColumnsOf(
      ComputeTrajectoryErrors(tables.truth, truth,
                              {.truth_sigma = dataset.truth_sigma}),
      tables.truth);
}

}  // namespace

void WriteMethodFiles(const Dataset& dataset, const Solution& solution,
                      const MethodTables& tables, ResultFolder* folder) {
  if (solution.states.empty()) return;
  const std::string& method = solution.method;
  if (tables.at.size() > 0) {
    WriteSolutionCsv(folder->Path(method + ".at.csv"), tables.at,
                     ProgramLine(dataset), dataset.epoch_gps_ns);
  }
  if (solution.modes) {
    WriteModes(folder->Path(method + ".modes.csv"), solution, dataset);
  }
  if (tables.comparison && tables.truth.size() > 0) {
    WriteErrorCsv(folder->Path(method + ".errors.csv"),
                  ErrorsAtTruth(dataset, tables), ProgramLine(dataset),
                  dataset.epoch_gps_ns);
  }
  if (HasConstantSeries(solution)) {
    WriteConstantCsv(folder->Path(method + ".constants.csv"), solution,
                     ProgramLine(dataset), dataset.epoch_gps_ns);
  }
}

void WriteReport(const RunRequest& request, const RunSummary& summary,
                 ResultFolder* folder) {
  const std::filesystem::path path = folder->Path(kReportName);
  WriteFileAtomically(path.string(),
                      ReportPage({{.folder = path.parent_path(),
                                   .shown = request.out,
                                   .summary = SummaryJson(summary)}}));
}

std::string DescribeReport(const RunRequest& request) {
  if (!request.report) return "";
  return "report in " +
         (std::filesystem::path(request.out) / kReportName).string() + "\n";
}

MethodSummary Summarize(const Dataset& dataset, const Solution& solution,
                        const MethodTables& tables) {
  if (!solution.states.empty()) {
    MethodSummary summary = SummarizeMethod(
        dataset, solution,
        tables.comparison ? std::optional(tables.comparison->statistics)
                          : std::nullopt);
    if (MethodOf(solution.method).attitude_alone()) {
      const BroadMetric broad = EvaluateBroad(tables.truth, dataset.truth);
      if (broad.count > 0) summary.broad = broad;
    }
    return summary;
  }
  MethodSummary summary;
  summary.method = solution.method;
  summary.converged = solution.converged;
  summary.grade = solution.grade;
  summary.evidence = solution.evidence;
  summary.verdict = solution.verdict;
  return summary;
}

std::optional<StartSummary> SummarizeStart(const StartReport* start) {
  if (start == nullptr) return std::nullopt;
  return StartSummary{.t = start->t,
                      .alignment = start->alignment,
                      .why = start->why,
                      .position = start->position,
                      .attitude = start->attitude,
                      .heading = start->heading,
                      .position_sigma = start->position_sigma,
                      .velocity_sigma = start->velocity_sigma,
                      .attitude_sigma = start->attitude_sigma};
}

}  // namespace hindsight
