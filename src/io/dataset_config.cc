#include "io/dataset_config.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/units.h"
#include "io/number_format.h"

namespace hindsight {
namespace {

constexpr int kDigits = 12;

/// A unit as it is written and its size in SI.
struct PrintedUnit {
  const char* name;
  double si = 1.0;
};
constexpr PrintedUnit kMetres{"m"};
constexpr PrintedUnit kSeconds{"s"};
constexpr PrintedUnit kMetresPerSecond{"m/s"};
constexpr PrintedUnit kDegrees{"deg", kDegree};
constexpr PrintedUnit kDegreesPerHour{"deg/h", kDegree / kHour};
constexpr PrintedUnit kMilliGs{"mg", kMilliG};
constexpr PrintedUnit kMicrotesla{"uT"};

/// Builds block-style YAML, two blanks a level.
class YamlText {
 public:
  void Open(const std::string& key) {
    Line(key + ":");
    ++level_;
  }
  void Close() { --level_; }
  void Text(const std::string& key, const std::string& value) {
    Line(key + ": " + value);
  }
  void Number(const std::string& key, double value, const PrintedUnit& unit) {
    Text(key, FormatGeneral(value / unit.si, kDigits) + " " + unit.name);
  }
  void Vector(const std::string& key, const Eigen::Vector3d& value,
              const PrintedUnit& unit) {
    std::string list = "[";
    for (int i = 0; i < 3; ++i) {
      list += (i > 0 ? ", " : "") + FormatGeneral(value(i) / unit.si, kDigits) +
              " " + unit.name;
    }
    Text(key, list + "]");
  }
  void Vector(const std::string& key,
              const std::optional<Eigen::Vector3d>& value,
              const PrintedUnit& unit) {
    if (value) Vector(key, *value, unit);
  }
  void Line(const std::string& line) {
    text_.append(static_cast<std::size_t>(2 * level_), ' ');
    text_ += line + "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  int level_ = 0;
};

void AppendNoise(const ImuNoise& noise, YamlText* yaml) {
  yaml->Open("noise");
  yaml->Number("gyro", noise.gyro_noise_density,
               {"deg/sqrt(h)", kDegreePerSqrtHour});
  yaml->Number("accel", noise.accel_noise_density, {"m/s/sqrt(h)", 1.0 / 60.0});
  const auto bias = [&](const std::string& sensor, double walk, double tau,
                        const PrintedUnit& walk_unit,
                        const PrintedUnit& bias_unit) {
    if (walk <= 0.0) return;
    if (std::isfinite(tau)) {
      yaml->Number(sensor + "_bias_sigma", walk * std::sqrt(0.5 * tau),
                   bias_unit);
      yaml->Number(sensor + "_bias_tau", tau, kSeconds);
    } else {
      yaml->Number(sensor + "_bias_walk", walk, walk_unit);
    }
  };
  bias("gyro", noise.gyro_bias_walk, noise.gyro_bias_tau, {"rad/s/sqrt(s)"},
       kDegreesPerHour);
  bias("accel", noise.accel_bias_walk, noise.accel_bias_tau, {"m/s^2/sqrt(s)"},
       kMilliGs);
  if (noise.gyro_noise_per_rate > 0.0) {
    yaml->Number("gyro_per_rate", noise.gyro_noise_per_rate, {"sqrt(s)"});
  }
  yaml->Close();
}

const char* TypeName(const Sensor& sensor) {
  switch (sensor.type) {
    case SensorType::kPosition:
      return "position";
    case SensorType::kVelocity:
      return "velocity";
    case SensorType::kHeight:
      return "height";
    case SensorType::kOdometer:
      return "odometer";
    case SensorType::kMagnetometer:
      return "magnetometer";
    case SensorType::kDvl:
      return "dvl";
    case SensorType::kAcousticFix:
      return "acoustic";
    default:
      throw InputError("aiding stream '" + sensor.name +
                       "' cannot be written as CSV");
  }
}

/// What an odometer's file does not say.
void AppendOdometer(const AidingStream& stream, YamlText* yaml) {
  const Sensor& sensor = stream.sensor;
  if (sensor.type != SensorType::kOdometer) return;
  const auto first = std::get<Odometer>(stream.measurements.front().model);
  if (first.form == Odometer::Form::kIncrements) {
    yaml->Text("form", "increments");
    yaml->Number("sigma", first.sigma.x(), kMetres);
    if (sensor.count_sigma > 0.0) {
      yaml->Number("count_sigma", sensor.count_sigma, kMetres);
    }
  } else {
    yaml->Text("form", first.form == Odometer::Form::kForward ? "forward"
                                                              : "three_axis");
    yaml->Vector("sigma", first.sigma, kMetresPerSecond);
  }
  yaml->Vector("mounting", EulerFromQuaternion(sensor.q_sb), kDegrees);
  yaml->Number("scale", sensor.scale, {"1"});
}

/// What a magnetometer's file does not say.
void AppendMagnetometer(const AidingStream& stream, YamlText* yaml) {
  if (stream.sensor.type != SensorType::kMagnetometer) return;
  const MagneticSurroundings& magnetic = stream.sensor.magnetic;
  const auto first = std::get<MagneticField>(stream.measurements.front().model);
  const bool vector = first.form == MagneticField::Form::kVector;
  yaml->Text("form", vector ? "vector" : "heading");
  yaml->Number("sigma", first.sigma, kMicrotesla);
  yaml->Number("horizontal", magnetic.horizontal, kMicrotesla);
  if (vector) yaml->Number("down", magnetic.down, kMicrotesla);
  yaml->Number("declination", magnetic.declination, kDegrees);
  yaml->Vector("hard_iron", magnetic.hard_iron_b, kMicrotesla);
}

void AppendMagneticEstimates(const MagneticSurroundings& magnetic,
                             YamlText* yaml) {
  yaml->Vector("hard_iron", magnetic.hard_iron_sigma, kMicrotesla);
  if (magnetic.declination_sigma) {
    yaml->Number("declination", *magnetic.declination_sigma, kDegrees);
  }
  if (magnetic.disturbance_sigma) {
    yaml->Number("disturbance", *magnetic.disturbance_sigma, kMicrotesla);
    yaml->Number("disturbance_tau", magnetic.disturbance_tau, kSeconds);
  }
}

void AppendDvl(const AidingStream& stream, YamlText* yaml) {
  const Sensor& sensor = stream.sensor;
  if (sensor.type != SensorType::kDvl) return;
  const auto first = std::get<Dvl>(stream.measurements.front().model);
  if (first.form == Dvl::Form::kBeams) {
    yaml->Text("form", "beams");
    yaml->Number("beam_angle", first.beam_angle, kDegrees);
    yaml->Number("beam_azimuth", first.beam_azimuth, kDegrees);
    yaml->Number("sigma", first.sigma.x(), kMetresPerSecond);
  } else {
    yaml->Text("form", "three_axis");
    yaml->Vector("sigma", Eigen::Vector3d(first.sigma.head<3>()),
                 kMetresPerSecond);
  }
  yaml->Text("track", first.water ? "water" : "bottom");
  yaml->Vector("mounting", EulerFromQuaternion(sensor.q_sb), kDegrees);
  yaml->Number("scale", sensor.scale, {"1"});
  if (!sensor.current_sigma) return;
  yaml->Open("current");
  yaml->Number("sigma", *sensor.current_sigma, kMetresPerSecond);
  if (std::isfinite(sensor.current_length)) {
    yaml->Number("length", sensor.current_length, kMetres);
  } else if (std::isfinite(sensor.current_tau)) {
    yaml->Number("time", sensor.current_tau, kSeconds);
  }
  yaml->Close();
}

std::string PositionText(const Geodetic& position) {
  return "[" + FormatGeneral(position.latitude / kDegree, 16) + " deg, " +
         FormatGeneral(position.longitude / kDegree, 16) + " deg, " +
         FormatGeneral(position.height, kDigits) + " m]";
}

void AppendAcoustic(const AidingStream& stream, YamlText* yaml) {
  const Sensor& sensor = stream.sensor;
  if (sensor.type != SensorType::kAcousticFix) return;
  const auto first = std::get<AcousticFix>(stream.measurements.front().model);
  yaml->Text("transponder", PositionText(GeodeticFromEcef(first.p_t_e)));
  if (first.has_range) yaml->Number("sigma", first.sigma_range, kMetres);
  if (first.has_bearing) {
    yaml->Number("bearing_sigma", first.sigma_bearing, kDegrees);
  }
  yaml->Vector("mounting", EulerFromQuaternion(sensor.q_sb), kDegrees);
  yaml->Number("scale", sensor.scale, {"1"});
}

void AppendEstimates(const AidingStream& stream, YamlText* yaml) {
  const Sensor& sensor = stream.sensor;
  const MagneticSurroundings& magnetic = sensor.magnetic;
  // That of an unknown clock comes with the search for it.
  const bool clock = sensor.time_offset_sigma && !stream.clock_unknown;
  if (!sensor.lever_arm_sigma && !sensor.mounting_sigma &&
      !sensor.scale_sigma && !clock && !magnetic.hard_iron_sigma &&
      !magnetic.declination_sigma && !magnetic.disturbance_sigma &&
      !sensor.offset_sigma) {
    return;
  }
  yaml->Open("estimate");
  yaml->Vector("lever_arm", sensor.lever_arm_sigma, kMetres);
  AppendMagneticEstimates(magnetic, yaml);
  yaml->Vector("mounting", sensor.mounting_sigma, kDegrees);
  if (sensor.scale_sigma) yaml->Number("scale", *sensor.scale_sigma, {"1"});
  if (clock) {
    yaml->Number("time_offset", *sensor.time_offset_sigma, kSeconds);
  }
  if (sensor.offset_sigma) {
    yaml->Number("offset", *sensor.offset_sigma, kMetres);
  }
  yaml->Close();
}

void AppendSensor(const AidingStream& stream, YamlText* yaml) {
  const Sensor& sensor = stream.sensor;
  yaml->Open(sensor.name);
  yaml->Text("type", TypeName(sensor));
  yaml->Text("file", sensor.name + ".csv");
  AppendOdometer(stream, yaml);
  AppendMagnetometer(stream, yaml);
  AppendDvl(stream, yaml);
  AppendAcoustic(stream, yaml);
  if (!sensor.lever_arm_b.isZero(0.0)) {
    yaml->Vector("lever_arm", sensor.lever_arm_b, kMetres);
  }
  if (stream.clock_unknown) {
    yaml->Text("time_offset", "unknown");
  } else if (sensor.time_offset != 0.0) {
    yaml->Number("time_offset", sensor.time_offset, kSeconds);
  }
  if (sensor.gate_probability) {
    yaml->Text("gate", FormatGeneral(*sensor.gate_probability, kDigits));
  }
  AppendEstimates(stream, yaml);
  yaml->Close();
}

void AppendInitial(const InitialState& initial, YamlText* yaml) {
  yaml->Text("alignment",
             AlignmentNames()[static_cast<std::size_t>(initial.alignment)]);
  yaml->Open("initial");
  if (initial.t) yaml->Number("time", *initial.t, kSeconds);
  if (initial.position) {
    yaml->Text("position", PositionText(*initial.position));
  }
  yaml->Vector("velocity", initial.v_n, kMetresPerSecond);
  yaml->Vector("attitude", initial.euler, kDegrees);
  if (initial.heading) yaml->Number("heading", *initial.heading, kDegrees);
  yaml->Vector("gyro_bias", initial.gyro_bias, kDegreesPerHour);
  yaml->Vector("accel_bias", initial.accel_bias, kMilliGs);
  yaml->Vector("position_sigma", initial.position_sigma, kMetres);
  yaml->Vector("velocity_sigma", initial.velocity_sigma, kMetresPerSecond);
  yaml->Vector("attitude_sigma", initial.attitude_sigma, kDegrees);
  yaml->Vector("gyro_bias_sigma", initial.gyro_bias_sigma, kDegreesPerHour);
  yaml->Vector("accel_bias_sigma", initial.accel_bias_sigma, kMilliGs);
  yaml->Close();
}

void AppendStationary(const StationaryOptions& options, YamlText* yaml) {
  if (!options.enabled) return;
  yaml->Open("stationary");
  yaml->Number("window", options.window, kSeconds);
  yaml->Number("gyro_threshold", options.gyro_threshold, {"rad/s"});
  yaml->Number("accel_threshold", options.accel_threshold, {"m/s^2"});
  yaml->Number("velocity_sigma", options.velocity_sigma, kMetresPerSecond);
  yaml->Number("rate_sigma", options.rate_sigma, {"rad/s"});
  yaml->Close();
}

void AppendWithholdings(const std::vector<Withholding>& withholdings,
                        YamlText* yaml) {
  if (withholdings.empty()) return;
  yaml->Open("withhold");
  for (const Withholding& w : withholdings) {
    std::string line = "- {sensor: " + w.sensor +
                       ", every: " + FormatGeneral(w.every, kDigits) +
                       " s, length: " + FormatGeneral(w.length, kDigits) + " s";
    if (w.from) line += ", from: " + FormatGeneral(*w.from, kDigits) + " s";
    yaml->Line(line + "}");
  }
  yaml->Close();
}

}  // namespace

std::string DatasetConfigYaml(const Dataset& dataset) {
  YamlText yaml;
  yaml.Line("# Simulated recording; truth.csv is exact.");
  yaml.Text("name", dataset.name);
  yaml.Open("imu");
  yaml.Text("file", "imu.csv");
  yaml.Text("kind", dataset.imu.kind == ImuStream::Kind::kRates ? "rates"
                                                                : "increments");
  yaml.Number("max_gap", dataset.imu.max_gap, kSeconds);
  AppendNoise(dataset.imu.noise, &yaml);
  yaml.Close();
  if (std::any_of(dataset.streams.begin(), dataset.streams.end(),
                  [](const AidingStream& stream) {
                    return !stream.measurements.empty();
                  })) {
    yaml.Open("aiding");
    for (const AidingStream& stream : dataset.streams) {
      // A recording without a single measurement has no file either.
      if (stream.measurements.empty()) continue;
      AppendSensor(stream, &yaml);
    }
    yaml.Close();
  }
  AppendInitial(dataset.initial, &yaml);
  AppendStationary(dataset.stationary, &yaml);
  if (!dataset.truth.empty()) {
    yaml.Open("truth");
    yaml.Text("file", "truth.csv");
    if (!dataset.truth_lever_arm_b.isZero(0.0)) {
      yaml.Vector("lever_arm", dataset.truth_lever_arm_b, kMetres);
    }
    yaml.Close();
  }
  AppendWithholdings(dataset.withholdings, &yaml);
  yaml.Open("nodes");
  yaml.Number("max_spacing", dataset.max_node_spacing, kSeconds);
  yaml.Close();
  return yaml.text();
}

}  // namespace hindsight
