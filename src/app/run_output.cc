#include "app/run_output.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/report_page.h"
#include "base/error.h"
#include "dataset/injection.h"
#include "evaluation/broad_metric.h"
#include "evaluation/truth_comparison.h"
#include "imu/imu_link.h"
#include "imu/mean_reading.h"
#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/constant_csv.h"
#include "io/write/error_csv.h"
#include "io/write/kml.h"
#include "io/write/motion_csv.h"
#include "io/write/nav.h"
#include "io/write/solution_csv.h"
#include "io/write/tum.h"
#include "problems/method.h"

namespace hindsight {
namespace {

/// Multiples of 1/rate within the solution's span.
std::vector<double> UniformTimes(const Solution& solution, double rate) {
  const double begin = std::ceil(solution.states.front().t * rate);
  const double end = std::floor(solution.states.back().t * rate);
  std::vector<double> times;
  for (double k = begin; k <= end; ++k) times.push_back(k / rate);
  return times;
}

SolutionTable TableAt(const Eigen::Vector3d& point_b, const Dataset& dataset,
                      const Solution& solution) {
  const bool moved = !point_b.isZero(0.0);
  if (!moved && dataset.mounting_sigma.isZero(0.0)) {
    return TableFromSolution(solution);
  }
  const Solution known = WithMountingSigma(solution, dataset.mounting_sigma);
  return TableFromSolution(moved ? MoveToPoint(known, dataset.imu, point_b)
                                 : known);
}

/// Some rows of a column that may be empty.
template <typename T>
void AppendRows(const std::vector<T>& from,
                const std::vector<std::size_t>& rows, std::vector<T>* to) {
  if (from.empty()) return;
  for (const std::size_t row : rows) to->push_back(from[row]);
}

/// That the data are not as recorded; empty if they are.
std::string InjectionRemark(const Dataset& dataset) {
  std::string remark;
  for (const Injection& injection : dataset.injections) {
    remark += std::string(remark.empty() ? "" : "; ") +
              "error injected on purpose: " + Describe(injection);
  }
  return remark;
}

/// The program and the remark.
std::string ProgramLine(const Dataset& dataset) {
  const std::string remark = InjectionRemark(dataset);
  return kProgram + (remark.empty() ? "" : "; " + remark);
}

void WriteExports(const RunRequest& request, const Dataset& dataset,
                  const std::string& method, const SolutionTable& table,
                  ResultFolder* folder) {
  const std::string remark = InjectionRemark(dataset);
  if (request.exports.contains("tum")) {
    WriteTum(folder->Path(method + ".tum"), table, remark);
  }
  if (request.exports.contains("kml")) {
    WriteKml(folder->Path(method + ".kml"), table, dataset.epoch_gps_ns,
             dataset.name + " " + method, remark);
  }
  if (!request.exports.contains("nav")) return;
  WriteNav(folder->Path(method + ".nav"), table, dataset.epoch_gps_ns);
  // The format knows no comments.
  if (remark.empty()) return;
  WriteFileAtomically(folder->Path(method + ".nav.txt"), remark + "\n");
}

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

void AppendRows(const SolutionTable& from, const std::vector<std::size_t>& rows,
                SolutionTable* to) {
  to->method = from.method;
  AppendRows(from.t, rows, &to->t);
  AppendRows(from.p_e, rows, &to->p_e);
  AppendRows(from.v_e, rows, &to->v_e);
  AppendRows(from.q_eb, rows, &to->q_eb);
  AppendRows(from.P_position, rows, &to->P_position);
  AppendRows(from.P_velocity, rows, &to->P_velocity);
  AppendRows(from.P_attitude, rows, &to->P_attitude);
  AppendRows(from.sigma_euler, rows, &to->sigma_euler);
  AppendRows(from.b_g, rows, &to->b_g);
  AppendRows(from.b_a, rows, &to->b_a);
  AppendRows(from.sigma_b_g, rows, &to->sigma_b_g);
  AppendRows(from.sigma_b_a, rows, &to->sigma_b_a);
  AppendRows(from.separation, rows, &to->separation);
  AppendRows(from.accel_sigma, rows, &to->accel_sigma);
  AppendRows(from.magnetic, rows, &to->magnetic);
  AppendRows(from.separations, rows, &to->separations);
}

/// One who wants rows of a solution.
struct Wish {
  std::vector<double> times;  ///< ascending
  Eigen::Vector3d point_b;    ///< of which point, from the IMU [m]
  SolutionTable* table;
};

/// Times that anyone wishes, once.
std::vector<double> AllTimes(const std::vector<Wish>& wishes) {
  std::vector<double> all;
  for (const Wish& wish : wishes) {
    all.insert(all.end(), wish.times.begin(), wish.times.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// The rows of `sampled` at those of `times` that are among its own.
std::vector<std::size_t> RowsAt(const std::vector<double>& times,
                                const Solution& sampled) {
  std::vector<std::size_t> rows;
  auto t =
      std::lower_bound(times.begin(), times.end(), sampled.states.front().t);
  for (std::size_t k = 0; k < sampled.states.size(); ++k) {
    while (t != times.end() && *t < sampled.states[k].t) ++t;
    if (t != times.end() && *t == sampled.states[k].t) rows.push_back(k);
  }
  return rows;
}

/// Fulfils all wishes in one walk, piece by piece, since a row of a solution,
/// with its whole covariance, is several times as large as that of a table.
void SampleOnce(const Dataset& dataset, const Reconstruction& reconstruction,
                const Solution& solution, const std::vector<Wish>& wishes) {
  constexpr std::ptrdiff_t kPiece = 10000;
  const std::vector<double> times = AllTimes(wishes);
  for (auto begin = times.begin(); begin != times.end();) {
    const auto end = begin + std::min(kPiece, times.end() - begin);
    const Solution piece = reconstruction.Sample(solution, {begin, end});
    std::optional<Eigen::Vector3d> point_b;
    SolutionTable table;
    for (const Wish& wish : wishes) {
      const std::vector<std::size_t> rows = RowsAt(wish.times, piece);
      if (rows.empty()) continue;
      if (point_b != wish.point_b) {
        point_b = wish.point_b;
        table = TableAt(wish.point_b, dataset, piece);
      }
      AppendRows(table, rows, wish.table);
    }
    begin = end;
  }
}

/// What the IMU read at ascending times within the solution, calibrated as the
/// last node before each has it.
std::vector<Kinematics> MotionAt(const std::vector<double>& times,
                                 const Solution& solution,
                                 const ImuStream& imu) {
  std::vector<ImuCalibration> calibrations;
  std::size_t k = 0;
  for (const double t : times) {
    while (k + 1 < solution.states.size() && solution.states[k + 1].t <= t) ++k;
    calibrations.push_back(CalibrationOf(solution.layout, solution.states[k]));
  }
  return MeanMotion(imu, times, calibrations);
}

/// Throws InputError if a time of --at is outside the solution's span.
void CheckTimesCovered(const RunRequest& request, const Solution& solution) {
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

}  // namespace

const char* const kProgram = "hindsight " HINDSIGHT_VERSION;

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

MethodTables SampleMethod(const RunRequest& request, const Dataset& dataset,
                          const Reconstruction& reconstruction,
                          const Solution& solution) {
  MethodTables tables;
  if (solution.states.empty()) return tables;
  CheckTimesCovered(request, solution);
  std::vector<Wish> wishes = {{request.at, request.point_b, &tables.at}};
  if (request.attitude_alone) {
    tables.truth = TableAt(Eigen::Vector3d::Zero(), dataset, solution);
  } else {
    wishes.push_back({TruthTimes(dataset, solution.states.front().t,
                                 solution.states.back().t),
                      dataset.truth_lever_arm_b, &tables.truth});
  }
  if (request.rate) {
    wishes.push_back({UniformTimes(solution, *request.rate), request.point_b,
                      &tables.output});
  } else {
    tables.output = TableAt(request.point_b, dataset, solution);
  }
  SampleOnce(dataset, reconstruction, solution, wishes);
  tables.motion = MotionAt(tables.output.t, solution, dataset.imu);
  return tables;
}

void WriteMethodFiles(const RunRequest& request, const Dataset& dataset,
                      const Solution& solution, const MethodTables& tables,
                      ResultFolder* folder) {
  if (solution.states.empty()) return;
  const std::string& method = solution.method;
  const auto write = [&](const std::string& suffix,
                         const SolutionTable& table) {
    if (table.size() == 0) return;
    WriteSolutionCsv(folder->Path(method + suffix), table, ProgramLine(dataset),
                     dataset.epoch_gps_ns);
  };
  write(".csv", tables.output);
  write(".at.csv", tables.at);
  if (!request.attitude_alone) write(kTruthSuffix, tables.truth);
  if (solution.modes) {
    WriteModes(folder->Path(method + ".modes.csv"), solution, dataset);
  }
  if (!dataset.truth.empty() && tables.truth.size() > 0) {
    TruthSeries truth = dataset.truth;
    ThinTruth(&truth);
    WriteErrorCsv(
        folder->Path(method + ".errors.csv"),
        ColumnsOf(ComputeTrajectoryErrors(tables.truth, truth,
                                          {.truth_sigma = dataset.truth_sigma}),
                  tables.truth),
        ProgramLine(dataset), dataset.epoch_gps_ns);
  }
  WriteMotionCsv(folder->Path(method + ".motion.csv"), tables.output.t,
                 tables.motion, ProgramLine(dataset), dataset.epoch_gps_ns);
  if (HasConstantSeries(solution)) {
    WriteConstantCsv(folder->Path(method + ".constants.csv"), solution,
                     ProgramLine(dataset), dataset.epoch_gps_ns);
  }
  WriteExports(request, dataset, method, tables.output, folder);
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
    MethodSummary summary = SummarizeMethod(dataset, solution, tables.truth);
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
