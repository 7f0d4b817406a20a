#include "simulation/sensor_errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "geometry/so3.h"

namespace hindsight {
namespace {

/// Numbers of the random streams; those of aiding sensors come from names.
enum Stream : std::uint64_t {
  kGyroNoise = 1,
  kGyroBias,
  kGyroWalk,
  kAccelNoise,
  kAccelBias,
  kAccelWalk,
  kAccelScale,
  kGyroScale,
};

/// 64-bit FNV-1a, kept clear of the small numbers of the IMU's streams.
std::uint64_t StreamOf(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash | (1ULL << 63);
}

Eigen::Vector3d StartBias(const Eigen::Vector3d& mean,
                          const Eigen::Vector3d& sigma, std::uint64_t seed,
                          Stream stream) {
  return mean + sigma.cwiseProduct(Random(seed, stream).NormalVector3());
}

}  // namespace

ImuErrors::ImuErrors(const ImuErrorModel& model, ImuStream::Kind kind,
                     double rate_hz, std::uint64_t seed)
    : kind_(kind),
      dt_(1.0 / rate_hz),
      gyro_{StartBias(model.gyro_bias, model.gyro_bias_sigma, seed, kGyroBias),
            Eigen::Vector3d::Ones() + StartBias(model.gyro_scale,
                                                model.gyro_scale_sigma, seed,
                                                kGyroScale),
            model.noise.GyroBiasEvolution().Phi(dt_),
            std::sqrt(model.noise.GyroBiasEvolution().Q(dt_)),
            model.noise.gyro_noise_density,
            model.noise.gyro_noise_per_rate,
            Random(seed, kGyroNoise),
            Random(seed, kGyroWalk)},
      accel_{
          StartBias(model.accel_bias, model.accel_bias_sigma, seed, kAccelBias),
          Eigen::Vector3d::Ones() + StartBias(model.accel_scale,
                                              model.accel_scale_sigma, seed,
                                              kAccelScale),
          model.noise.AccelBiasEvolution().Phi(dt_),
          std::sqrt(model.noise.AccelBiasEvolution().Q(dt_)),
          model.noise.accel_noise_density,
          0.0,
          Random(seed, kAccelNoise),
          Random(seed, kAccelWalk)} {}

Eigen::Vector3d ImuErrors::Measure(const Eigen::Vector3d& truth,
                                   Channel* channel) const {
  const Eigen::Vector3d bias_before = channel->bias;
  // The start values hold at the first stamp.
  if (!first_ && channel->walk_sigma > 0.0) {
    channel->bias = channel->phi * channel->bias +
                    channel->walk_sigma * channel->walk.NormalVector3();
  }
  const bool increments = kind_ == ImuStream::Kind::kIncrements;
  double density = channel->noise_density;
  if (channel->noise_per_rate > 0.0) {
    const double rate = truth.norm() / (increments ? dt_ : 1.0);
    density = std::hypot(density, channel->noise_per_rate * rate);
  }
  const Eigen::Vector3d noise = density * channel->noise.NormalVector3();
  const Eigen::Vector3d scaled = channel->scale_factor.cwiseProduct(truth);
  if (increments) {
    return scaled + (0.5 * dt_) * (bias_before + channel->bias) +
           std::sqrt(dt_) * noise;
  }
  return scaled + channel->bias + noise / std::sqrt(dt_);
}

void ImuErrors::Apply(ImuSample* sample) {
  sample->gyro = Measure(sample->gyro, &gyro_);
  sample->accel = Measure(sample->accel, &accel_);
  first_ = false;
}

namespace {

/// Velocity of the sensor's point in the sensor's axes.
Eigen::Vector3d SensorVelocity(const Sensor& sensor, const Motion& motion) {
  return sensor.q_sb * (motion.q_eb.conjugate() * motion.v_e +
                        motion.w_eb_b.cross(sensor.lever_arm_b));
}

/// Forward distance over [from, to], by Gauss's rule of three points in steps
/// of at most 20 ms.
double DistanceTravelled(const Sensor& sensor, double from, double to,
                         Trajectory* trajectory) {
  constexpr double kStep = 0.02;
  const double root = std::sqrt(0.6);
  const int steps =
      std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
  const double half = 0.5 * (to - from) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double middle = from + (2 * i + 1) * half;
    const auto speed = [&](double t) {
      return SensorVelocity(sensor, trajectory->At(t)).x();
    };
    sum += half / 9.0 *
           (5.0 * speed(middle - root * half) + 8.0 * speed(middle) +
            5.0 * speed(middle + root * half));
  }
  return sum;
}

Dvl PerfectDvl(const AidingModel& model, const Motion& motion) {
  Dvl dvl = model.dvl;
  Eigen::Vector3d v_e = motion.v_e;
  if (dvl.water) v_e -= NedAxes(motion.p_e) * model.current_n;
  Motion through = motion;
  through.v_e = v_e;
  const Eigen::Vector3d v_d = SensorVelocity(model.sensor, through);
  for (int i = 0; i < dvl.components(); ++i) {
    dvl.speed(i) = dvl.Direction(i).dot(v_d);
  }
  return dvl;
}

AcousticFix PerfectAcoustic(const AidingModel& model, const Motion& motion) {
  AcousticFix fix = model.acoustic;
  const Eigen::Vector3d d_b =
      motion.q_eb.conjugate() * (fix.p_t_e - motion.p_e) -
      model.sensor.lever_arm_b;
  const Eigen::Vector3d d_s = model.sensor.q_sb * d_b;
  fix.range = d_s.norm();
  fix.azimuth = std::atan2(d_s.y(), d_s.x());
  fix.depression = std::atan2(d_s.z(), d_s.head<2>().norm());
  return fix;
}

MeasurementModel PerfectMeasurement(const AidingModel& model,
                                    const Motion& motion) {
  const Eigen::Vector3d& l = model.sensor.lever_arm_b;
  const Eigen::Vector3d p_e = motion.p_e + motion.q_eb * l;
  const Eigen::Matrix3d R_n = model.sigma.cwiseAbs2().asDiagonal();
  switch (model.sensor.type) {
    case SensorType::kPosition:
      return PositionFix{p_e, R_n};
    case SensorType::kVelocity: {
      const Eigen::Vector3d v_e =
          motion.v_e + motion.q_eb * motion.w_eb_b.cross(l);
      return VelocityFix{NedAxes(motion.p_e).transpose() * v_e, R_n};
    }
    case SensorType::kHeight:
      return HeightFix{GeodeticFromEcef(p_e).height, model.sigma.z()};
    case SensorType::kOdometer: {
      Odometer odometer;
      odometer.form = model.odometer_form;
      odometer.sigma = model.sigma;
      odometer.speed = SensorVelocity(model.sensor, motion).x();
      return odometer;
    }
    case SensorType::kMagnetometer: {
      const MagneticSurroundings& magnetic = model.sensor.magnetic;
      const Eigen::Vector3d m_e =
          NedAxes(motion.p_e) *
          UndisturbedField(magnetic, magnetic.declination);
      return MagneticField{motion.q_eb.conjugate() * m_e + magnetic.hard_iron_b,
                           model.sigma.x(), model.magnetic_form};
    }
    case SensorType::kDvl:
      return PerfectDvl(model, motion);
    case SensorType::kAcousticFix:
      return PerfectAcoustic(model, motion);
    default:
      throw std::logic_error("sensor '" + model.sensor.name +
                             "' is of a type that is not simulated");
  }
}

/// Stamps that the model asks for, whatever the span of the motion.
std::vector<double> Stamps(const AidingModel& model, double first,
                           double last) {
  if (!model.times.empty()) return model.times;
  constexpr double kStampTolerance = 1e-6;
  std::vector<double> stamps;
  for (auto k = static_cast<long>(
           std::ceil(first * model.rate_hz - kStampTolerance));
       static_cast<double>(k) / model.rate_hz <= last; ++k) {
    stamps.push_back(static_cast<double>(k) / model.rate_hz);
  }
  return stamps;
}

/// Increments between neighbours; the first count begins the first of them.
void CountDistance(const Sensor& sensor, Trajectory* trajectory,
                   std::vector<Measurement>* measurements) {
  for (std::size_t i = 1; i < measurements->size(); ++i) {
    auto& odometer = std::get<Odometer>((*measurements)[i].model);
    odometer.t_from = (*measurements)[i - 1].t;
    odometer.distance = DistanceTravelled(
        sensor, odometer.t_from + sensor.time_offset,
        (*measurements)[i].t + sensor.time_offset, trajectory);
  }
  if (!measurements->empty()) measurements->erase(measurements->begin());
}

}  // namespace

std::vector<Measurement> PerfectMeasurements(const AidingModel& model,
                                             int sensor, Trajectory* trajectory,
                                             double t_end) {
  std::vector<Measurement> measurements;
  const double offset = model.sensor.time_offset;
  const double first = std::max(trajectory->t_begin() - offset, model.from);
  const double last = std::min(t_end - offset, model.to);
  for (const double t : Stamps(model, first, last)) {
    const bool missing = std::any_of(
        model.outages.begin(), model.outages.end(),
        [&](const TimeSpan& o) { return t >= o.begin && t < o.end; });
    const double t_true = t + offset;
    if (missing || t < model.from || t > model.to || t_true > t_end ||
        t_true < trajectory->t_begin()) {
      continue;
    }
    Measurement z;
    z.t = t;
    z.sensor = sensor;
    z.model = PerfectMeasurement(model, trajectory->At(t_true));
    measurements.push_back(z);
  }
  if (model.sensor.type == SensorType::kOdometer &&
      model.odometer_form == Odometer::Form::kIncrements) {
    CountDistance(model.sensor, trajectory, &measurements);
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

DrawnSensor DrawSensor(const AidingModel& model, std::uint64_t seed) {
  DrawnSensor drawn{model.sensor, {}};
  Sensor& sensor = drawn.sensor;
  auto& truth = drawn.true_constants;
  if (sensor.type == SensorType::kOdometer || sensor.scale_sigma) {
    truth[sensor.name + "_scale"] = DrawScale(model, seed);
  }
  if (sensor.offset_sigma) {
    truth[sensor.name + "_offset"] = DrawOffset(model, seed);
  }
  if (sensor.current_sigma) {
    truth[sensor.name + "_current[north]"] = model.current_n.x();
    truth[sensor.name + "_current[east]"] = model.current_n.y();
    truth[sensor.name + "_current[down]"] = model.current_n.z();
  }
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

namespace {

void AddDvlErrors(const AidingModel& model, double scale, Random* random,
                  Dvl* dvl) {
  for (int i = 0; i < dvl->components(); ++i) {
    dvl->speed(i) =
        (1.0 + scale) * dvl->speed(i) + dvl->sigma(i) * random->Normal();
    if (model.beam_dropout > 0.0) {
      dvl->valid[static_cast<std::size_t>(i)] =
          random->Uniform() >= model.beam_dropout;
    }
  }
}

void AddAcousticErrors(double scale, Random* random, AcousticFix* fix) {
  fix->range = (1.0 + scale) * fix->range + fix->sigma_range * random->Normal();
  // Across the line of sight, so that azimuths scatter more near the vertical.
  fix->azimuth +=
      fix->sigma_bearing * random->Normal() / std::cos(fix->depression);
  fix->depression += fix->sigma_bearing * random->Normal();
}

}  // namespace

void AddMeasurementErrors(const AidingModel& model, std::uint64_t seed,
                          std::vector<Measurement>* measurements) {
  Random random(seed, StreamOf(model.sensor.name));
  const double scale = DrawScale(model, seed);
  double count_error = model.sensor.count_sigma > 0.0
                           ? model.sensor.count_sigma * random.Normal()
                           : 0.0;
  const double offset = DrawOffset(model, seed);
  for (Measurement& z : *measurements) {
    if (auto* position = std::get_if<PositionFix>(&z.model)) {
      const Eigen::Vector3d error_n =
          model.sigma.cwiseProduct(random.NormalVector3());
      position->p_e += NedAxes(position->p_e) * error_n;
    } else if (auto* velocity = std::get_if<VelocityFix>(&z.model)) {
      velocity->v_n += model.sigma.cwiseProduct(random.NormalVector3());
    } else if (auto* height = std::get_if<HeightFix>(&z.model)) {
      height->height += offset + model.sigma.z() * random.Normal();
    } else if (auto* magnetic = std::get_if<MagneticField>(&z.model)) {
      magnetic->field_b += model.sigma.x() * random.NormalVector3();
    } else if (auto* odometer = std::get_if<Odometer>(&z.model)) {
      const Eigen::Vector3d error =
          model.sigma.cwiseProduct(random.NormalVector3());
      if (odometer->form == Odometer::Form::kIncrements) {
        odometer->distance =
            (1.0 + scale) * odometer->distance + error.x() - count_error;
        if (model.sensor.count_sigma > 0.0) {
          count_error = model.sensor.count_sigma * random.Normal();
          odometer->distance += count_error;
        }
        continue;
      }
      odometer->speed = (1.0 + scale) * odometer->speed + error.x();
      odometer->side_down += error.tail<2>();
    } else if (auto* dvl = std::get_if<Dvl>(&z.model)) {
      AddDvlErrors(model, scale, &random, dvl);
    } else if (auto* fix = std::get_if<AcousticFix>(&z.model)) {
      AddAcousticErrors(scale, &random, fix);
    }
  }
  std::erase_if(*measurements,
                [](const Measurement& z) { return Rows(z) == 0; });
}

}  // namespace hindsight
