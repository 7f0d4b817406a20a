#include "app/run.h"

#include <fmt/core.h>

#include <future>
#include <iostream>
#include <memory>
#include <utility>

#include "app/command.h"
#include "app/input_digests.h"
#include "app/load_recording.h"
#include "app/measurement_log.h"
#include "app/method_writer.h"
#include "app/result_folder.h"
#include "app/run_findings.h"
#include "app/run_output.h"
#include "app/run_report.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/parallel.h"
#include "dataset/known_constants.h"
#include "evaluation/grade.h"
#include "io/config/config.h"
#include "io/config/constants_reader.h"
#include "io/write/comparison.h"
#include "io/write/fix_csv.h"
#include "io/write/residual_csv.h"
#include "io/write/summary.h"
#include "measurements/sensor_kind.h"
#include "problems/method.h"

namespace hindsight {
namespace {

ReconstructionOptions Options(const RunRequest& request, Progress* progress) {
  ReconstructionOptions options;
  options.methods = request.methods;
  options.attitude_alone = request.attitude_alone;
  options.from = request.from;
  options.to = request.to;
  options.node_times = request.at;
  options.error = request.error;
  options.max_time = request.max_time;
  options.h_infinity = request.h_infinity;
  options.modified_h_infinity = request.modified_h_infinity;
  options.progress = [progress](const std::string& stage, double fraction) {
    progress->Update(stage, fraction);
  };
  return options;
}

/// Names the configuration if it does not say where the recording begins.
std::unique_ptr<Reconstruction> Prepare(const std::string& config,
                                        const Dataset& dataset,
                                        const ReconstructionOptions& options) {
  try {
    return std::make_unique<Reconstruction>(dataset, options);
  } catch (const NoInitialPosition& error) {
    const std::string what = config + ": " + error.what() +
                             "; --methods=LIST of " + MethodNames(true) +
                             ", which estimate attitude alone, need none";
    const auto& streams = dataset.streams;
    if (std::all_of(streams.begin(), streams.end(), [](const auto& stream) {
          return stream.sensor.kind->magnetic;
        })) {
      throw OnlyAttitude(what);
    }
    throw NoInitialPosition(what);
  }
}

/// A method that fails leaves the others their say: its solution is empty and
/// its verdict is the reason.
Solution RunMethod(Reconstruction* reconstruction, const std::string& method) {
  try {
    return reconstruction->Run(method);
  } catch (const EstimationError& error) {
    return FailedSolution(method, error.what());
  }
}

/// What a draft took for granted is doubtful until somebody says that it is so.
void DoubtUnconfirmed(const std::vector<std::string>& unconfirmed,
                      Solution* solution) {
  if (unconfirmed.empty() || solution->states.empty()) return;
  std::string what = "taken for granted, and not confirmed by --yes: ";
  for (std::size_t i = 0; i < unconfirmed.size(); ++i) {
    what += (i == 0 ? "" : "; ") + unconfirmed[i];
  }
  AddEvidence({.rule = "unconfirmed",
               .grade = Grade::kDoubtful,
               .what = what,
               .remedies = {"--yes, or the list `unconfirmed` of the "
                            "configuration without what is so"}},
              solution);
}

/// Throws the reason if no method gave as much as a trajectory.
void CheckAnyTrajectory(const std::vector<Solution>& solutions) {
  std::string reasons;
  for (const Solution& solution : solutions) {
    if (!solution.states.empty()) return;
    reasons += (reasons.empty() ? "" : "; ") + solution.method + " is " +
               solution.verdict;
  }
  throw EstimationError(reasons);
}

/// Work in passes of the forward filter; reading, start and writing take about
/// one each.
std::vector<Progress::Step> PlanOf(const RunRequest& request) {
  std::vector<Progress::Step> steps = {{"reading", 1.0}, {"start", 1.0}};
  for (const std::string& method : request.methods) {
    steps.push_back({method, MethodOf(method).work});
  }
  steps.push_back({"writing", request.report ? 2.0 : 1.0});
  return steps;
}

/// Throws InputError if the constants come from this recording: what it says of
/// them would count twice.
void RequireOtherRecording(const Dataset& dataset,
                           const std::vector<FileDigest>& inputs) {
  if (!dataset.constants) return;
  const std::string& source = dataset.constants->source;
  for (const FileDigest& there : RecordedFiles(source)) {
    for (const FileDigest& here : inputs) {
      if (here.sha256 != there.sha256) continue;
      throw InputError(
          SummaryOf(source).string(), 0,
          fmt::format("is of this recording: it read {} as well, which would "
                      "count twice; expected constants of other recordings",
                      here.path));
    }
  }
}

int ReconstructInto(const RunRequest& request, ResultFolder* folder) {
  SetThreadCount(request.threads);
  Progress progress(request.progress);
  progress.Plan(PlanOf(request));
  progress.Update("reading", 0.0);
  InputDigests digests(FilesReadBy(request));
  ResolvedConfig resolved;
  Dataset dataset = LoadRecording(request, digests.read(), &resolved);

  progress.Begin("start");
  const auto rests = std::make_shared<const RestMemo>(dataset);
  auto findings =
      InBackground([&dataset, rests] { return FindingsOf(dataset, *rests); });
  ReconstructionOptions options = Options(request, &progress);
  options.rests = rests;
  std::unique_ptr<Reconstruction> reconstruction =
      Prepare(request.config, dataset, options);
  if (const StartReport* start = reconstruction->start()) {
    resolved.yaml += CommentOnStart(*start, dataset.initial);
  }
  // Beside, as the disk may have much to write before it.
  auto writing = InBackground([&] {
    WriteResolvedConfig(resolved, folder->Path("config.resolved.yaml"));
  });
  if (ThreadCount() == 1) writing.get();
  const std::vector<std::string> unconfirmed =
      request.confirmed ? std::vector<std::string>() : resolved.unconfirmed;
  std::vector<FileDigest> inputs = digests.Take();
  RequireOtherRecording(dataset, inputs);
  RunSummary summary = {
      .program = kProgram,
      .dataset = dataset.name,
      .epoch_gps_ns = dataset.epoch_gps_ns,
      .constants_from =
          dataset.constants ? dataset.constants->source : std::string(),
      .constants_of_recording = ConstantsOfOneRecording(dataset),
      .inputs = std::move(inputs),
      .start = SummarizeStart(reconstruction->start()),
      .policies = dataset.policies,
      .best = "",
      .methods = {}};
  const std::vector<UnobservedSpan> unobserved = DescribeBeforehand(
      dataset, std::move(findings), reconstruction.get(), &progress, &summary);
  if (writing.valid()) writing.get();
  std::vector<Solution> solutions;
  solutions.reserve(request.methods.size());
  MethodWriter writer(request, dataset, *reconstruction, &summary, folder);
  bool any_trajectory = false;
  for (const std::string& method : request.methods) {
    progress.Begin(method);
    solutions.push_back(RunMethod(reconstruction.get(), method));
    Solution* solution = &solutions.back();
    any_trajectory = any_trajectory || !solution->states.empty();
    DoubtUnconfirmed(unconfirmed, solution);
    LogDownWeighted(dataset, *solution);
    writer.Add(solution);
  }
  progress.Begin("writing");
  // What is kept in a file takes the system a while to give back: beside the rest.
  auto ending = InBackground([&] { reconstruction.reset(); });
  const bool has_measurements = any_trajectory && !request.attitude_alone;
  if (has_measurements) {
    WriteResidualCsv(folder->Path("residuals.csv"), solutions, dataset);
  }
  writer.Finish();
  CheckAnyTrajectory(solutions);
  ending.get();
  ending = InBackground([&] { dataset.imu = {}; });
  ShareDisagreements(&solutions);
  ShareFindings(&solutions);
  AdviseBetterMethods(&solutions);
  const Solution& best = Best(solutions);
  NameBest(best, solutions, &summary);
  if (has_measurements && HasFixes(dataset)) {
    WriteFixCsv(folder->Path("fixes.csv"), best, dataset);
  }
  ending.get();
  progress.Clear();
  summary.complete = true;
  if (request.report) WriteReport(request, summary, folder);
  folder->Commit(kSummaryName, SummaryText(summary));
  progress.Finish();

  const TableStyle style = StyleOfOutput();
  const std::string residuals = ResidualOverview(summary, style);
  std::cout << "\n"
            << ComparisonTable(summary, style)
            << (residuals.empty() ? "" : "\n" + residuals)
            << DescribeRivals(solutions) << DescribeMethodNotes(solutions)
            << DescribeOwnUnobserved(unobserved, solutions)
            << DescribeEvidence(solutions, style)
            << DescribeContradictions(summary)
            << DescribeConstants(dataset, best) << "\nresults in "
            << request.out << "\n"
            << DescribeReport(request) << DescribeVerdict(best, style);
  return StatusOf(best.grade);
}

}  // namespace

int Reconstruct(const RunRequest& request) {
  return WithResultFolder(
      OutputOf(request), [&] { return InputsOf(request); },
      [&](ResultFolder* folder) { return ReconstructInto(request, folder); });
}

}  // namespace hindsight
