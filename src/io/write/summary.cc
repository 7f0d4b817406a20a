#include "io/write/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "evaluation/observability.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

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

/// Of the readings of the field; nothing without readings.
std::optional<double> DisturbedShare(const std::vector<signed char>& magnetic) {
  long readings = 0;
  long disturbed = 0;
  for (const signed char verdict : magnetic) {
    readings += verdict != 0 ? 1 : 0;
    disturbed += verdict < 0 ? 1 : 0;
  }
  if (readings == 0) return std::nullopt;
  return static_cast<double>(disturbed) / static_cast<double>(readings);
}

}  // namespace

std::vector<std::string> NotesOf(const Dataset& dataset) {
  constexpr std::size_t kMost = 10;
  const ImuStream& imu = dataset.imu;
  const std::vector<std::size_t> ends = DropOuts(imu);
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < std::min(ends.size(), kMost); ++i) {
    const double begin = imu.samples[ends[i] - 1].t;
    notes.push_back(
        fmt::format("imu: no samples for {:.3f} s from t = {:.3f} s, bridged",
                    imu.samples[ends[i]].t - begin, begin));
  }
  if (ends.size() > kMost) {
    notes.push_back(
        fmt::format("imu: {} more drop-outs bridged", ends.size() - kMost));
  }
  notes.insert(notes.end(), dataset.notes.begin(), dataset.notes.end());
  return notes;
}

std::string WithholdingWarning(const Dataset& dataset) {
  const bool none = !dataset.withholdings.empty() && dataset.outages.empty();
  return none ? "no whole outage of the withholding rules fits in" : "";
}

std::vector<FixSummary> SummarizeFixes(const Dataset& dataset) {
  std::vector<FixSummary> all;
  for (const AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->is_position) continue;
    FixSummary& summary = all.emplace_back();
    summary.stream = stream.sensor.name;
    double sum = 0.0;
    long count = 0;
    for (const Measurement& z : stream.measurements) {
      const auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr) continue;
      ++summary.count;
      if (std::isfinite(fix->quality)) {
        ++summary.by_quality[static_cast<int>(std::lround(fix->quality))];
      }
      if (!std::isfinite(fix->satellites)) continue;
      sum += fix->satellites;
      ++count;
    }
    if (count > 0) summary.satellites = sum / static_cast<double>(count);
  }
  return all;
}

std::vector<MountingSummary> MountingsOf(const Dataset& dataset,
                                         const Solution& solution) {
  std::vector<MountingSummary> mountings;
  if (solution.states.empty()) return mountings;
  for (const Block& block : solution.layout.blocks()) {
    if (block.key.kind != BlockKind::kMounting) continue;
    const Eigen::Vector3d m =
        solution.states.back().parameters.segment<3>(block.parameter_offset);
    const Sensor& sensor =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)].sensor;
    mountings.push_back(
        {sensor.name, EulerFromQuaternion(Exp(m) * sensor.q_sb)});
  }
  return mountings;
}

MethodSummary SummarizeMethod(
    const Dataset& dataset, const Solution& solution,
    const std::optional<TrajectoryStatistics>& error) {
  MethodSummary m;
  m.method = solution.method;
  m.seconds = solution.seconds;
  m.converged = solution.converged;
  m.iterations = solution.iterations;
  m.grade = solution.grade;
  m.evidence = solution.evidence;
  m.verdict = solution.verdict;
  if (error) {
    m.error = error;
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
  m.constant_covariance = CovarianceOfConstants(solution);
  m.mountings = MountingsOf(dataset, solution);
  m.unobserved = solution.unobserved;
  m.rivals = solution.rivals;
  m.observer = solution.observer;
  m.found = solution.notes;
  if (solution.attitude) {
    m.field_disturbed = DisturbedShare(solution.attitude->magnetic);
  }
  if (!solution.states.empty()) {
    m.duration = solution.states.back().t - solution.states.front().t;
    m.distance = DistanceOf(solution);
  }
  return m;
}

std::vector<double> TruthTimes(const TruthSeries& truth, double from,
                               double to) {
  std::vector<double> times;
  for (const TruthPoint& point : truth) {
    if (from <= point.t && point.t <= to) times.push_back(point.t);
  }
  return times;
}

}  // namespace hindsight
