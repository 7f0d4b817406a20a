#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulation/sensor_errors.h"

namespace hindsight {
namespace {

/// Integral of the rate of a count over [from, to], by Gauss's rule of three
/// points in steps of at most 20 ms.
double Count(const SensorSettings& settings, double from, double to,
             Trajectory* trajectory) {
  constexpr double kStep = 0.02;
  const double root = std::sqrt(0.6);
  const int steps =
      std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
  const double half = 0.5 * (to - from) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double middle = from + (2 * i + 1) * half;
    const auto rate = [&](double t) {
      return settings.sensor.kind->count_rate(settings, trajectory->At(t));
    };
    sum += half / 9.0 *
           (5.0 * rate(middle - root * half) + 8.0 * rate(middle) +
            5.0 * rate(middle + root * half));
  }
  return sum;
}

/// With what follows from the settings.
SensorSettings Completed(const AidingModel& model) {
  SensorSettings settings = model;
  if (model.sensor.kind->perfect == nullptr) {
    throw std::logic_error("sensor '" + model.sensor.name +
                           "' is of a kind that is not simulated");
  }
  if (model.sensor.kind->complete != nullptr) {
    model.sensor.kind->complete(&settings);
  }
  return settings;
}

/// Times at which one spacing more of the path is behind; the end counts if it
/// is short of the last by a micrometre or less.
std::vector<double> StampsAlong(double spacing, double t_end,
                                Trajectory* trajectory) {
  constexpr double kStep = 0.01;  // [s]
  constexpr double kShort = 1e-6;
  const auto speed = [&](double t) { return trajectory->At(t).v_e.norm(); };
  std::vector<double> stamps;
  double behind = 0.0;
  double from = trajectory->t_begin();
  double v_from = speed(from);
  for (long k = 1; from < t_end; ++k) {
    const double to =
        std::min(trajectory->t_begin() + static_cast<double>(k) * kStep, t_end);
    const double v_to = speed(to);
    const double length = 0.5 * (v_from + v_to) * (to - from);
    for (double next = spacing * static_cast<double>(stamps.size() + 1);
         next <= behind + length + (to < t_end ? 0.0 : kShort);
         next += spacing) {
      const double t = from + (to - from) * (next - behind) / length;
      stamps.push_back(std::min(std::round(t * 1e6) / 1e6, t_end));
    }
    behind += length;
    from = to;
    v_from = v_to;
  }
  return stamps;
}

/// Stamps that the model asks for within a span.
std::vector<double> Stamps(const AidingModel& model, double first, double last,
                           Trajectory* trajectory) {
  if (model.spacing) {
    const double offset = model.sensor.time_offset;
    std::vector<double> stamps =
        StampsAlong(*model.spacing, last + offset, trajectory);
    for (double& t : stamps) t -= offset;
    return stamps;
  }
  constexpr double kStampTolerance = 1e-6;
  std::vector<double> stamps;
  for (auto k = static_cast<long>(
           std::ceil(first * model.rate_hz - kStampTolerance));
       static_cast<double>(k) / model.rate_hz <= last; ++k) {
    stamps.push_back(static_cast<double>(k) / model.rate_hz);
  }
  return stamps;
}

/// What has come between neighbours; the first count begins the first of them.
void TakeCounts(const SensorSettings& settings, Trajectory* trajectory,
                std::vector<Measurement>* measurements) {
  const double offset = settings.sensor.time_offset;
  for (std::size_t i = 1; i < measurements->size(); ++i) {
    const double t_from = (*measurements)[i - 1].t;
    Measurement& z = (*measurements)[i];
    settings.sensor.kind->set_count(
        t_from, Count(settings, t_from + offset, z.t + offset, trajectory),
        &z.model);
  }
  if (!measurements->empty()) measurements->erase(measurements->begin());
}

}  // namespace

std::vector<Measurement> PerfectMeasurements(
    const AidingModel& model, int sensor, Trajectory* trajectory, double t_end,
    std::vector<Eigen::Quaterniond>* q_nb) {
  std::vector<Measurement> measurements;
  const SensorSettings settings = Completed(model);
  const SensorKind& kind = *model.sensor.kind;
  const double offset = model.sensor.time_offset;
  const double first = std::max(trajectory->t_begin() - offset, model.from);
  const double last = std::min(t_end - offset, model.to);
  for (const double t : Stamps(model, first, last, trajectory)) {
    const bool missing = std::any_of(
        model.outages.begin(), model.outages.end(),
        [&](const TimeSpan& o) { return t >= o.begin && t < o.end; });
    const double t_true = t + offset;
    if (missing || t < model.from || t > model.to || t_true > t_end ||
        t_true < trajectory->t_begin()) {
      continue;
    }
    const Motion motion = trajectory->At(t_true);
    const auto perfect = kind.perfect(settings, motion);
    if (!perfect) continue;
    measurements.push_back({t, sensor, false, *perfect});
    if (q_nb != nullptr && kind.add_lasting != nullptr) {
      q_nb->push_back(Eigen::Quaterniond(NedAxes(motion.p_e).transpose()) *
                      motion.q_eb);
    }
  }
  if (kind.counts != nullptr && kind.counts(settings)) {
    TakeCounts(settings, trajectory, &measurements);
  }
  return measurements;
}

}  // namespace hindsight
