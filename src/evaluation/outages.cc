#include "evaluation/outages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kEndTolerance = 1e-6;  // [s]
constexpr double kLeastDistance = 1.0;  // [m]

/// Trapezoidal integral of the speed over [begin, end], the part of it that
/// the states cover.
double DistanceTravelled(const std::vector<State>& states, double begin,
                         double end) {
  double distance = 0.0;
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    const double t0 = states[k].t;
    const double t1 = states[k + 1].t;
    const double from = std::max(t0, begin);
    const double to = std::min(t1, end);
    if (to <= from) continue;
    const double v0 = states[k].v_e.norm();
    const double slope = (states[k + 1].v_e.norm() - v0) / (t1 - t0);
    const double middle = 0.5 * (from + to);
    distance += (to - from) * (v0 + slope * (middle - t0));
  }
  return distance;
}

bool IsNedVector(const SensorKind& kind) {
  return kind.is_position || kind.is_velocity;
}

/// The outage that the withheld measurement belongs to, or nullptr.
OutageError* FindOutage(const ResidualRecord& record, const Sensor& sensor,
                        std::vector<OutageError>* outages) {
  // A record may carry the stamp or the instant after the time offset, which
  // may be estimated.
  constexpr double kSigmas = 4.0;
  double nearest = std::abs(sensor.time_offset) +
                   kSigmas * sensor.time_offset_sigma.value_or(0.0) + 1e-6;
  OutageError* found = nullptr;
  for (OutageError& candidate : *outages) {
    if (candidate.outage.sensor != record.sensor) continue;
    const double outside = std::max({0.0, candidate.outage.t_begin - record.t,
                                     record.t - candidate.outage.t_end});
    // Equally near at the seam of two outages: it belongs to the later one.
    if (outside <= nearest) {
      nearest = outside;
      found = &candidate;
    }
  }
  return found;
}

/// While accumulating, the two rms fields hold sums of squares.
void Accumulate(const RowVector& residual, OutageError* out) {
  const double horizontal = residual.head(2).norm();
  const double total = residual.norm();
  if (!out->error) out->error = PredictionError();
  PredictionError& e = *out->error;
  ++out->count;
  e.horizontal_rms += horizontal * horizontal;
  e.total_rms += total * total;
  e.horizontal_max = std::max(e.horizontal_max, horizontal);
  e.total_max = std::max(e.total_max, total);
}

}  // namespace

std::vector<OutageError> ComputeOutageErrors(const Solution& solution,
                                             const Dataset& dataset) {
  std::vector<OutageError> outages;
  for (const Outage& outage : dataset.outages) {
    const auto sensor = static_cast<std::size_t>(outage.sensor);
    const SensorKind& kind = *dataset.streams.at(sensor).sensor.kind;
    if (!IsNedVector(kind)) continue;
    // What the solution does not cover from end to end is no outage of it.
    if (solution.states.empty() || outage.t_begin < solution.states.front().t ||
        outage.t_end > solution.states.back().t + kEndTolerance) {
      continue;
    }
    OutageError entry;
    entry.outage = outage;
    entry.kind = &kind;
    entry.distance =
        DistanceTravelled(solution.states, outage.t_begin, outage.t_end);
    outages.push_back(entry);
  }
  for (const ResidualRecord& record : solution.residuals) {
    if (!record.withheld) continue;
    const auto sensor = static_cast<std::size_t>(record.sensor);
    OutageError* outage =
        FindOutage(record, dataset.streams.at(sensor).sensor, &outages);
    if (outage != nullptr) Accumulate(record.residual, outage);
  }
  for (OutageError& outage : outages) {
    if (!outage.error) continue;
    const auto n = static_cast<double>(outage.count);
    outage.error->horizontal_rms = std::sqrt(outage.error->horizontal_rms / n);
    outage.error->total_rms = std::sqrt(outage.error->total_rms / n);
    if (outage.kind->is_position && outage.distance >= kLeastDistance) {
      outage.drift_percent =
          100.0 * outage.error->horizontal_max / outage.distance;
    }
  }
  return outages;
}

std::optional<PredictionError> PoolOutageErrors(
    const std::vector<OutageError>& outages, const SensorKind& kind) {
  PredictionError pooled;
  double n = 0.0;
  for (const OutageError& outage : outages) {
    if (outage.kind != &kind || !outage.error) continue;
    const auto count = static_cast<double>(outage.count);
    const PredictionError& e = *outage.error;
    n += count;
    pooled.horizontal_rms += count * e.horizontal_rms * e.horizontal_rms;
    pooled.total_rms += count * e.total_rms * e.total_rms;
    pooled.horizontal_max = std::max(pooled.horizontal_max, e.horizontal_max);
    pooled.total_max = std::max(pooled.total_max, e.total_max);
  }
  if (n == 0.0) return std::nullopt;
  pooled.horizontal_rms = std::sqrt(pooled.horizontal_rms / n);
  pooled.total_rms = std::sqrt(pooled.total_rms / n);
  return pooled;
}

}  // namespace hindsight
