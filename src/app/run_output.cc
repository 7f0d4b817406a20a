#include "app/run_output.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "dataset/injection.h"
#include "io/atomic_file.h"
#include "io/config.h"
#include "io/kml.h"
#include "io/nav.h"
#include "io/solution_csv.h"
#include "io/tum.h"

namespace hindsight {
namespace {

constexpr double kLeastTruthSpacing = 0.1;  // [s]

/// Multiples of 1/rate within the solution's span.
std::vector<double> UniformTimes(const Solution& solution, double rate) {
  const double begin = std::ceil(solution.states.front().t * rate);
  const double end = std::floor(solution.states.back().t * rate);
  std::vector<double> times;
  for (double k = begin; k <= end; ++k) times.push_back(k / rate);
  return times;
}

SolutionTable Table(const RunRequest& request, const Dataset& dataset,
                    const Solution& solution) {
  if (request.point_b.isZero(0.0)) return TableFromSolution(solution);
  return TableFromSolution(MoveToPoint(solution, dataset.imu, request.point_b));
}

template <typename T>
void Append(const std::vector<T>& tail, std::vector<T>* all) {
  all->insert(all->end(), tail.begin(), tail.end());
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
                  const ResultFolder& folder) {
  const std::string remark = InjectionRemark(dataset);
  if (request.exports.contains("tum")) {
    WriteTum(folder.Path(method + ".tum"), table, remark);
  }
  if (request.exports.contains("kml")) {
    WriteKml(folder.Path(method + ".kml"), table, dataset.epoch_gps_ns,
             dataset.name + " " + method, remark);
  }
  if (!request.exports.contains("nav")) return;
  WriteNav(folder.Path(method + ".nav"), table, dataset.epoch_gps_ns);
  // The format knows no comments.
  if (remark.empty()) return;
  WriteFileAtomically(folder.Path(method + ".nav.txt"), remark + "\n");
}

/// t[s] and the probability of each mode.
void WriteModes(const std::string& path, const Solution& solution,
                const std::string& program) {
  std::string text = "# program: " + program + "\nt[s]";
  for (const std::string& name : solution.mode_names) text += "," + name;
  text += "\n";
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    text += Format("%.6f", solution.states[k].t);
    for (const double p : solution.mode_probabilities[k]) {
      text += Format(",%.6g", p);
    }
    text += "\n";
  }
  WriteFileAtomically(path, text);
}

void AppendRows(const SolutionTable& tail, SolutionTable* all) {
  all->method = tail.method;
  Append(tail.t, &all->t);
  Append(tail.p_e, &all->p_e);
  Append(tail.v_e, &all->v_e);
  Append(tail.q_eb, &all->q_eb);
  Append(tail.P_position, &all->P_position);
  Append(tail.P_velocity, &all->P_velocity);
  Append(tail.P_attitude, &all->P_attitude);
  Append(tail.sigma_euler, &all->sigma_euler);
  Append(tail.b_g, &all->b_g);
  Append(tail.b_a, &all->b_a);
  Append(tail.sigma_b_g, &all->sigma_b_g);
  Append(tail.sigma_b_a, &all->sigma_b_a);
}

/// Piece by piece, since a row of a solution, with its whole covariance, is
/// several times as large as that of a table.
SolutionTable SampledTable(const RunRequest& request, const Dataset& dataset,
                           const Reconstruction& reconstruction,
                           const Solution& solution,
                           const std::vector<double>& times) {
  constexpr std::ptrdiff_t kPiece = 10000;
  SolutionTable table;
  for (auto begin = times.begin(); begin != times.end();) {
    const auto end = begin + std::min(kPiece, times.end() - begin);
    const Solution piece = reconstruction.Sample(solution, {begin, end});
    AppendRows(Table(request, dataset, piece), &table);
    begin = end;
  }
  return table;
}

double PeakRssMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Throws InputError if a time of --at is outside the solution's span.
void CheckTimesCovered(const RunRequest& request, const Solution& solution) {
  const double begin = solution.states.front().t;
  const double end = solution.states.back().t;
  for (const double t : request.at) {
    if (t >= begin && t <= end) continue;
    throw InputError(
        Format("--at: t = %.6f s is outside the reconstructed "
               "interval from %.6f s to %.6f s",
               t, begin, end));
  }
}

}  // namespace

const char* const kProgram = "hindsight " HINDSIGHT_VERSION;

OutputRequest OutputOf(const RunRequest& request) {
  return {request.out, request.force, request.clean};
}

ResultFolder::Paths InputsOf(const RunRequest& request) {
  ResultFolder::Paths inputs = ConfigInputs(
      request.config,
      {.data_root = request.data_root, .without = request.without});
  if (!request.at_file.empty()) inputs.emplace_back(request.at_file);
  return inputs;
}

void WriteMethodFiles(const RunRequest& request, const Dataset& dataset,
                      const Reconstruction& reconstruction,
                      const Solution& solution, const ResultFolder& folder) {
  if (solution.states.empty()) return;
  CheckTimesCovered(request, solution);
  const std::string& method = solution.method;
  const auto sample = [&](const std::vector<double>& times) {
    return SampledTable(request, dataset, reconstruction, solution, times);
  };
  const SolutionTable table =
      request.rate ? sample(UniformTimes(solution, *request.rate))
                   : Table(request, dataset, solution);
  WriteSolutionCsv(folder.Path(method + ".csv"), table, ProgramLine(dataset));
  if (!request.at.empty()) {
    WriteSolutionCsv(folder.Path(method + ".at.csv"), sample(request.at),
                     ProgramLine(dataset));
  }
  if (!solution.mode_probabilities.empty()) {
    WriteModes(folder.Path(method + ".modes.csv"), solution,
               ProgramLine(dataset));
  }
  WriteExports(request, dataset, method, table, folder);
}

MethodSummary Summarize(const Dataset& dataset,
                        const Reconstruction& reconstruction,
                        const Solution& solution) {
  const double peak_rss_mb = PeakRssMb();
  MethodSummary summary;
  if (solution.states.empty()) {
    summary.method = solution.method;
    summary.converged = solution.converged;
    summary.grade = solution.grade;
    summary.evidence = solution.evidence;
    summary.verdict = solution.verdict;
  } else {
    const std::vector<double> times = TruthTimes(
        dataset, solution.states.front().t, solution.states.back().t);
    summary = SummarizeMethod(
        dataset, solution,
        TableFromSolution(reconstruction.Sample(solution, times)),
        std::numeric_limits<double>::infinity());
  }
  summary.peak_rss_mb = peak_rss_mb;
  return summary;
}

void ThinTruth(std::vector<TruthPoint>* truth) {
  double last = -std::numeric_limits<double>::infinity();
  std::erase_if(*truth, [&last](const TruthPoint& point) {
    // A truth at 10 Hz is kept whole, whatever its stamps' rounding.
    if (point.t < last + 0.999 * kLeastTruthSpacing) return true;
    last = point.t;
    return false;
  });
}

StartSummary SummarizeStart(const StartReport& start) {
  return {.t = start.t,
          .alignment = start.alignment,
          .why = start.why,
          .position = start.position,
          .attitude = start.attitude,
          .heading = start.heading,
          .position_sigma = start.position_sigma,
          .velocity_sigma = start.velocity_sigma,
          .attitude_sigma = start.attitude_sigma};
}

}  // namespace hindsight
