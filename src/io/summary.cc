#include "io/summary.h"

#include "evaluation/truth_comparison.h"

namespace hindsight {
namespace {

/// Integral of the speed; nothing without velocities.
std::optional<double> DistanceOf(const Solution& solution) {
  if (!solution.layout.Has(BlockKind::kVelocity)) return std::nullopt;
  double distance = 0.0;
  for (std::size_t k = 1; k < solution.states.size(); ++k) {
    const State& a = solution.states[k - 1];
    const State& b = solution.states[k];
    distance += 0.5 * (a.v_e.norm() + b.v_e.norm()) * (b.t - a.t);
  }
  return distance;
}

}  // namespace

MethodSummary SummarizeMethod(const Dataset& dataset, const Solution& solution,
                              const SolutionTable& trajectory) {
  MethodSummary m;
  m.method = solution.method;
  m.seconds = solution.seconds;
  m.converged = solution.converged;
  m.iterations = solution.iterations;
  m.grade = solution.grade;
  m.evidence = solution.evidence;
  m.verdict = solution.verdict;
  if (!dataset.truth.empty()) {
    m.error = CompareWithTruth(trajectory, dataset.truth, {});
    // P of an observer is no covariance to begin with.
    if (!solution.observer) m.contradiction = Contradiction(*m.error);
  }
  m.outages = ComputeOutageErrors(solution, dataset);
  for (const OutageError& outage : m.outages) {
    const auto sensor = static_cast<std::size_t>(outage.outage.sensor);
    m.outage_sensors.push_back(dataset.streams[sensor].sensor.name);
  }
  m.residuals = ComputeResidualStatistics(solution, dataset);
  m.constants = solution.constants;
  m.unobserved = solution.unobserved;
  m.rivals = solution.rivals;
  m.observer = solution.observer;
  m.found = solution.notes;
  if (!solution.states.empty()) {
    m.duration = solution.states.back().t - solution.states.front().t;
    m.distance = DistanceOf(solution);
  }
  return m;
}

std::vector<double> TruthTimes(const Dataset& dataset, double from, double to) {
  std::vector<double> times;
  for (const TruthPoint& point : dataset.truth) {
    if (from <= point.t && point.t <= to) times.push_back(point.t);
  }
  return times;
}

}  // namespace hindsight
