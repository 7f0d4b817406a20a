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

}  // namespace

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
