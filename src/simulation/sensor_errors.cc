#include "simulation/sensor_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "geometry/so3.h"

namespace hindsight {
namespace {

/// 64-bit FNV-1a, kept clear of the small numbers of the IMU's streams.
std::uint64_t StreamOf(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash | (1ULL << 63);
}

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

double DrawScale(const AidingModel& model, std::uint64_t seed) {
  if (!model.sensor.scale_sigma) return model.sensor.scale;
  return model.sensor.scale +
         *model.sensor.scale_sigma *
             Random(seed, StreamOf(model.sensor.name + "_scale")).Normal();
}

double DrawOffset(const AidingModel& model, std::uint64_t seed) {
  return model.sensor.offset_sigma.value_or(0.0) *
         Random(seed, StreamOf(model.sensor.name + "_offset")).Normal();
}

namespace {

/// One lasting error of one seed, from measurement to measurement.
class LastingDraws {
 public:
  LastingDraws(const LastingError& error, const std::string& name,
               std::uint64_t seed)
      : error_(error), random_(seed, StreamOf(name)), value_(error.value) {
    if (error.sigma) {
      value_ += error.sigma->cwiseProduct(random_.NormalVector3());
    }
  }

  const Eigen::Vector3d& value() const { return value_; }
  /// Of a Gauss-Markov process; a constant stays.
  void Advance(double dt) {
    if (!error_.sigma || !std::isfinite(error_.tau)) return;
    const double phi = std::exp(-dt / error_.tau);
    value_ =
        phi * value_ + std::sqrt(1.0 - phi * phi) *
                           error_.sigma->cwiseProduct(random_.NormalVector3());
  }

 private:
  LastingError error_;
  Random random_;
  Eigen::Vector3d value_;
};

LastingDraws DrawBias(const AidingModel& model, std::uint64_t seed) {
  return {model.sensor.bias, model.sensor.name + "_bias", seed};
}
LastingDraws DrawGroundBias(const AidingModel& model, std::uint64_t seed) {
  return {model.sensor.ground_bias, model.sensor.name + "_ground_bias", seed};
}

void AddLastingErrors(const AidingModel& model, std::uint64_t seed,
                      const std::vector<Eigen::Quaterniond>& q_nb,
                      std::vector<Measurement>* measurements) {
  const Sensor& sensor = model.sensor;
  if (sensor.kind->add_lasting == nullptr) return;
  if (!sensor.bias.sigma && !sensor.ground_bias.sigma) return;
  if (q_nb.size() != measurements->size()) {
    throw std::logic_error("sensor '" + sensor.name +
                           "' lacks the attitudes of its measurements");
  }
  LastingDraws bias = DrawBias(model, seed);
  LastingDraws ground = DrawGroundBias(model, seed);
  for (std::size_t k = 0; k < measurements->size(); ++k) {
    Measurement& z = (*measurements)[k];
    if (k > 0) {
      const double dt = z.t - (*measurements)[k - 1].t;
      bias.Advance(dt);
      ground.Advance(dt);
    }
    sensor.kind->add_lasting(
        bias.value(), sensor.q_sb * (q_nb[k].conjugate() * ground.value()),
        &z.model);
  }
}

/// Of one that is constant.
void TellLasting(const LastingError& error, const Eigen::Vector3d& value,
                 const std::string& name,
                 const std::array<const char*, 3>& axes,
                 std::map<std::string, double>* truth) {
  if (!error.sigma || std::isfinite(error.tau)) return;
  for (int i = 0; i < 3; ++i) {
    (*truth)[name + axes[static_cast<std::size_t>(i)]] = value(i);
  }
}

}  // namespace

DrawnSensor DrawSensor(const AidingModel& model, std::uint64_t seed) {
  DrawnSensor drawn{model.sensor, {}};
  Sensor& sensor = drawn.sensor;
  auto& truth = drawn.true_constants;
  if (sensor.scale != 0.0 || sensor.scale_sigma) {
    truth[sensor.name + "_scale"] = DrawScale(model, seed);
  }
  if (sensor.offset_sigma) {
    truth[sensor.name + "_offset"] = DrawOffset(model, seed);
  }
  if (sensor.current_sigma) {
    truth[sensor.name + "_current[north]"] = model.truth.current_n.x();
    truth[sensor.name + "_current[east]"] = model.truth.current_n.y();
    truth[sensor.name + "_current[down]"] = model.truth.current_n.z();
  }
  TellLasting(sensor.bias, DrawBias(model, seed).value(), sensor.name + "_bias",
              {"[x]", "[y]", "[z]"}, &truth);
  TellLasting(sensor.ground_bias, DrawGroundBias(model, seed).value(),
              sensor.name + "_ground_bias", {"[north]", "[east]", "[down]"},
              &truth);
  if (!model.draw_calibration) return drawn;
  Random random(seed, StreamOf(sensor.name + "_calibration"));
  const auto add = [&](const char* what, const Eigen::Vector3d& value) {
    static const char* const kAxes[] = {"[x]", "[y]", "[z]"};
    for (int i = 0; i < 3; ++i) {
      truth[sensor.name + what + kAxes[i]] = value(i);
    }
  };
  if (sensor.lever_arm_sigma) {
    add("_lever_arm", sensor.lever_arm_b);
    sensor.lever_arm_b +=
        sensor.lever_arm_sigma->cwiseProduct(random.NormalVector3());
  }
  if (sensor.mounting_sigma) {
    const Eigen::Vector3d m =
        sensor.mounting_sigma->cwiseProduct(random.NormalVector3());
    add("_mounting", m);
    sensor.q_sb = Exp(m).conjugate() * sensor.q_sb;
  }
  if (sensor.time_offset_sigma) {
    truth[sensor.name + "_time_offset"] = sensor.time_offset;
    sensor.time_offset += *sensor.time_offset_sigma * random.Normal();
  }
  return drawn;
}

void AddMeasurementErrors(const AidingModel& model, std::uint64_t seed,
                          const std::vector<Eigen::Quaterniond>& q_nb,
                          std::vector<Measurement>* measurements) {
  AddLastingErrors(model, seed, q_nb, measurements);
  Random random(seed, StreamOf(model.sensor.name));
  SensorSettings settings = Completed(model);
  settings.truth.scale = DrawScale(model, seed);
  settings.truth.offset = DrawOffset(model, seed);
  model.sensor.kind->disturb(settings, &random, measurements);
  std::erase_if(*measurements,
                [](const Measurement& z) { return Rows(z) == 0; });
}

}  // namespace hindsight
