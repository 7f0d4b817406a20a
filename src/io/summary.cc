#include "io/summary.h"

namespace hindsight {

MethodSummary SummarizeMethod(const Dataset& dataset, const Solution& solution,
                              const SolutionTable& trajectory, double max_gap) {
  MethodSummary m;
  m.method = solution.method;
  m.seconds = solution.seconds;
  m.converged = solution.converged;
  m.iterations = solution.iterations;
  m.usable = solution.usable;
  m.verdict = solution.verdict;
  if (!dataset.truth.empty()) {
    m.error = EvaluateTrajectory(
        trajectory, dataset.truth,
        {.max_gap = max_gap, .truth_lever_arm_b = dataset.truth_lever_arm_b});
  }
  m.outages = ComputeOutageErrors(solution, dataset);
  for (const OutageError& outage : m.outages) {
    const auto sensor = static_cast<std::size_t>(outage.outage.sensor);
    m.outage_sensors.push_back(dataset.streams[sensor].sensor.name);
  }
  m.residuals = ComputeResidualStatistics(solution, dataset);
  m.constants = solution.constants;
  m.unobserved = solution.unobserved;
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
