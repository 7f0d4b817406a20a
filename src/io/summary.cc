#include "io/summary.h"

namespace hindsight {

MethodSummary SummarizeMethod(const Dataset& dataset, const Solution& solution,
                              const SolutionTable& trajectory, double max_gap) {
  MethodSummary m;
  m.method = solution.method;
  m.seconds = solution.seconds;
  m.converged = solution.converged;
  m.iterations = solution.iterations;
  m.grade = solution.grade;
  m.evidence = solution.evidence;
  m.verdict = solution.verdict;
  if (!dataset.truth.empty()) {
    m.error = EvaluateTrajectory(
        trajectory, dataset.truth,
        {.max_gap = max_gap, .truth_lever_arm_b = dataset.truth_lever_arm_b});
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
  return m;
}

std::vector<double> TruthTimes(const Dataset& dataset, double from, double to) {
  // The rows beside a truth point tell the angular rate at it, by which a
  // lever arm moves its velocity.
  constexpr double kBeside = 0.01;
  const bool beside = !dataset.truth_lever_arm_b.isZero(0.0);
  std::vector<double> times;
  const auto add = [&](double t) {
    const bool later = times.empty() || t > times.back();
    if (later && from <= t && t <= to) times.push_back(t);
  };
  for (std::size_t k = 0; k < dataset.truth.size(); ++k) {
    const double t = dataset.truth[k].t;
    if (beside) add(t - kBeside);
    add(t);
    const bool dense =
        k + 1 < dataset.truth.size() && dataset.truth[k + 1].t <= t + kBeside;
    if (beside && !dense) add(t + kBeside);
  }
  return times;
}

}  // namespace hindsight
