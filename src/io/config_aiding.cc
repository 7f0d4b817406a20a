#include <array>
#include <cmath>

#include "base/units.h"
#include "io/config_streams.h"

namespace hindsight {
namespace {

struct AidingType {
  const char* name;
  SensorType type;
  const std::vector<FieldName>& (*fields)();
  Quantity sigma;
  bool sigma_in_file;
};

constexpr std::array kAidingTypes = {
    AidingType{"position", SensorType::kPosition, PositionFields,
               Quantity::kLength, true},
    AidingType{"velocity", SensorType::kVelocity, VelocityFields,
               Quantity::kSpeed, true},
    AidingType{"height", SensorType::kHeight, HeightFields, Quantity::kLength,
               true},
    AidingType{"depth", SensorType::kHeight, DepthFields, Quantity::kLength,
               true},
    AidingType{"dvl", SensorType::kDvl, DvlFields, Quantity::kSpeed, false},
    AidingType{"acoustic", SensorType::kAcousticFix, AcousticFields,
               Quantity::kLength, false},
    AidingType{"speed_course", SensorType::kSpeedCourse, SpeedCourseFields,
               Quantity::kSpeed, false},
    AidingType{"odometer", SensorType::kOdometer, OdometerFields,
               Quantity::kSpeed, false},
    AidingType{"non_holonomic", SensorType::kNonHolonomic, OdometerFields,
               Quantity::kSpeed, false},
    AidingType{"magnetometer", SensorType::kMagnetometer, MagnetometerFields,
               Quantity::kMagneticField, false},
    AidingType{"zero_velocity", SensorType::kZeroVelocity, ZeroVelocityFields,
               Quantity::kSpeed, false},
};

/// Of a mounting that the data give a first value.
constexpr double kFoundMountingSigma = 10.0 * kDegree;

const AidingType& ReadType(ConfigMap* map) {
  std::vector<std::string> names;
  for (const AidingType& type : kAidingTypes) names.emplace_back(type.name);
  return kAidingTypes[map->Choice("type", names, std::nullopt)];
}

std::set<int> ReadQualities(ConfigMap* map) {
  std::set<int> accepted;
  for (const std::string& text : map->List("accept_quality")) {
    const auto number = ParseNumber(text);
    if (!number || *number != std::floor(*number) || std::abs(*number) > 1e6) {
      map->Fail("accept_quality", "'" + text + "' is not a whole number");
    }
    accepted.insert(static_cast<int>(*number));
  }
  return accepted;
}

double ReadFactor(ConfigMap* map, const std::string& key,
                  const std::string& fallback) {
  const std::string text = map->Text(key, fallback);
  const auto number = ParseNumber(text);
  if (!number || !(*number > 0.0)) {
    map->Fail(key, "'" + text + "' is not a positive number");
  }
  return *number;
}

RobustLoss ReadLoss(ConfigMap* map) {
  RobustLoss loss;
  if (!map->Has("loss")) return loss;
  ConfigMap entry = map->Map("loss");
  const std::size_t kind = entry.Choice(
      "kind", {"none", "huber", "cauchy", "tukey", "geman_mcclure"},
      std::nullopt);
  loss.kind = static_cast<RobustLoss::Kind>(kind);
  loss.scale = ReadFactor(&entry, "scale", FormatNumber(loss.scale));
  entry.Finish();
  return loss;
}

/// Of an increment in the first place.
Eigen::Vector3d ReadIncrementSigma(ConfigMap* map) {
  return {map->Positive("sigma", Quantity::kLength), 1.0, 1.0};
}

Quantity NoiseQuantity(SensorType type) {
  return type == SensorType::kVelocity ? Quantity::kSpeed : Quantity::kLength;
}

/// Refuses a standard deviation of a Gauss-Markov error so small that rounding
/// would leave nothing positive definite.
void CheckNoiseSigma(ConfigMap* entry, const std::string& key,
                     Quantity quantity, double sigma) {
  constexpr double kLeast = 1e-6;
  if (!entry->Has(key) || sigma >= kLeast) return;
  entry->Fail(key, quantity == Quantity::kSpeed ? "expected at least 1e-6 m/s"
                                                : "expected at least 1e-6 m");
}

/// White, a Gauss-Markov error as states, or a mixture of inliers and outliers,
/// which is a loss.
void ReadNoise(ConfigMap* map, AidingConfig* config) {
  if (!map->Has("noise")) return;
  Sensor* sensor = &config->sensor;
  ConfigMap entry = map->Map("noise");
  const std::size_t model =
      entry.Choice("model", {"white", "gauss_markov", "mixture"}, std::nullopt);
  if (model == 1) {
    if (sensor->type != SensorType::kPosition &&
        sensor->type != SensorType::kVelocity &&
        sensor->type != SensorType::kHeight) {
      entry.Fail("model",
                 "gauss_markov is for position, velocity and height sensors");
    }
    for (const char* key : {"sigma", "sigma_scale", "correlations"}) {
      if (!map->Has(key)) continue;
      map->Fail(key,
                "does not go with noise of model gauss_markov, whose sigma and "
                "white take its place");
    }
    const Quantity quantity = NoiseQuantity(sensor->type);
    NoiseModel& noise = sensor->noise;
    noise.kind = NoiseModel::Kind::kGaussMarkov;
    noise.sigma = entry.Positive("sigma", quantity);
    CheckNoiseSigma(&entry, "sigma", quantity, noise.sigma);
    noise.tau = entry.Positive("tau", Quantity::kTime);
    noise.white_sigma = entry.Positive("white", quantity, 0.1 * noise.sigma);
    CheckNoiseSigma(&entry, "white", quantity, noise.white_sigma);
    // The file need not state what is not used.
    config->options.sigma = Eigen::Vector3d::Constant(noise.white_sigma);
  } else if (model == 2) {
    if (sensor->loss.kind != RobustLoss::Kind::kNone) {
      entry.Fail("model", "a mixture does not go with a loss");
    }
    RobustLoss& loss = sensor->loss;
    loss.kind = RobustLoss::Kind::kMixture;
    loss.scale = 1.0;
    loss.outlier_share =
        entry.Positive("outliers", Quantity::kRatio, loss.outlier_share);
    if (loss.outlier_share >= 1.0) {
      entry.Fail("outliers", "expected a share of less than 100 %");
    }
    loss.outlier_ratio =
        ReadFactor(&entry, "ratio", FormatNumber(loss.outlier_ratio));
    if (loss.outlier_ratio <= 1.0) {
      entry.Fail("ratio", "expected a number above 1");
    }
  }
  entry.Finish();
}

/// Forward, side and down, or those that the form measures.
Eigen::Vector3d ReadOdometerSigma(ConfigMap* map, Odometer::Form form) {
  const auto fail = [&](const char* expected) {
    map->Fail("sigma", std::string("expected ") + expected);
  };
  if (!map->Has("sigma")) fail("a standard deviation of each speed");
  if (form == Odometer::Form::kNonHolonomic) {
    const std::vector<std::string> items = map->List("sigma");
    if (items.size() != 2) fail("[side, down]");
    std::string text = items[0] + ", " + items[1];
    std::vector<double> values;
    try {
      values = ParseQuantities(text, Quantity::kSpeed);
    } catch (const std::invalid_argument& error) {
      map->Fail("sigma", error.what());
    }
    if (!(values[0] > 0.0 && values[1] > 0.0)) {
      fail("standard deviations greater than zero");
    }
    return {1.0, values[0], values[1]};
  }
  return *map->OptionalSigma("sigma", Quantity::kSpeed);
}

void ReadVehicle(ConfigMap* map, AidingConfig* config) {
  AidingReadOptions& options = config->options;
  Sensor& sensor = config->sensor;
  if (sensor.type == SensorType::kNonHolonomic) {
    options.odometer_form = Odometer::Form::kNonHolonomic;
    config->generated_rate = map->Positive("rate", Quantity::kFrequency);
  } else {
    constexpr std::array kForms = {Odometer::Form::kThreeAxis,
                                   Odometer::Form::kForward,
                                   Odometer::Form::kIncrements};
    options.odometer_form =
        kForms[map->Choice("form", {"three_axis", "forward", "increments"}, 0)];
    sensor.scale = ReadScale(map);
  }
  if (options.odometer_form == Odometer::Form::kIncrements) {
    options.sigma = ReadIncrementSigma(map);
    sensor.count_sigma = map->Number("count_sigma", Quantity::kLength, 0.0);
    if (sensor.count_sigma < 0.0) {
      map->Fail("count_sigma", "must not be negative");
    }
  } else {
    options.sigma = ReadOdometerSigma(map, options.odometer_form);
  }
  if (map->Has("level_on_average")) {
    config->level_sigma = map->Positive("level_on_average", Quantity::kAngle);
  }
  if (map->IsScalar("mounting")) {
    map->Choice("mounting", {"unknown"}, std::nullopt);
    sensor.mounting_unknown = true;
    return;
  }
  sensor.q_sb = ReadSensorMounting(map);
}

/// The heading needs only the horizontal part of the field, and that only as a
/// scale of its noise; the vector needs all of it.
void ReadMagnetometer(ConfigMap* map, AidingConfig* config) {
  AidingReadOptions& options = config->options;
  MagneticSurroundings& magnetic = config->sensor.magnetic;
  options.magnetic_form = map->Choice("form", {"vector", "heading"}, 1) == 0
                              ? MagneticField::Form::kVector
                              : MagneticField::Form::kHeading;
  options.C_bs = ReadMounting(map);
  options.sigma = Eigen::Vector3d::Constant(
      map->Positive("sigma", Quantity::kMagneticField));
  magnetic.declination = map->Number("declination", Quantity::kAngle, 0.0);
  magnetic.hard_iron_b = map->Vector("hard_iron", Quantity::kMagneticField,
                                     Eigen::Vector3d::Zero());
  if (options.magnetic_form == MagneticField::Form::kHeading) {
    magnetic.horizontal = map->Positive("horizontal", Quantity::kMagneticField,
                                        magnetic.horizontal);
    return;
  }
  magnetic.horizontal = map->Positive("horizontal", Quantity::kMagneticField);
  if (!map->Has("down")) {
    map->Fail("down", "is missing; expected the field's downward component");
  }
  magnetic.down = map->Number("down", Quantity::kMagneticField, 0.0);
}

void ReadMagneticEstimates(ConfigMap* estimate,
                           MagneticSurroundings* magnetic) {
  magnetic->hard_iron_sigma =
      estimate->OptionalSigma("hard_iron", Quantity::kMagneticField);
  if (estimate->Has("declination")) {
    magnetic->declination_sigma =
        estimate->Positive("declination", Quantity::kAngle);
  }
  if (estimate->Has("disturbance")) {
    magnetic->disturbance_sigma =
        estimate->Positive("disturbance", Quantity::kMagneticField);
    magnetic->disturbance_tau = estimate->Positive(
        "disturbance_tau", Quantity::kTime, magnetic->disturbance_tau);
  }
}

/// A sensor at a point of the vehicle, not of the IMU itself or of the field.
bool HasLeverArm(SensorType type) {
  return type != SensorType::kMagnetometer && type != SensorType::kZeroVelocity;
}

void ReadSigmas(ConfigMap* map, const AidingType& type,
                AidingReadOptions* options) {
  const bool one =
      type.type == SensorType::kHeight || type.type == SensorType::kSpeedCourse;
  if (!one) {
    options->sigma = map->OptionalSigma("sigma", type.sigma);
  } else if (map->Has("sigma")) {
    options->sigma.emplace().setConstant(map->Positive("sigma", type.sigma));
  }
  if (type.type == SensorType::kSpeedCourse) {
    if (!options->sigma) map->Fail("sigma", "is missing; expected a speed");
    options->course_sigma = map->Positive("course_sigma", Quantity::kAngle);
    options->course_above = map->Number("course_above", Quantity::kSpeed, 1.0);
    return;
  }
  if (options->sigma) {
    if (map->Has("sigma_scale")) {
      map->Fail("sigma_scale", "does not go with sigma");
    }
    return;
  }
  options->sigma_scale = ReadFactor(map, "sigma_scale", "1");
  options->use_correlations = map->Flag("correlations", true);
}

}  // namespace

std::optional<double> ReadGate(ConfigMap* map) {
  const std::string text = map->Text("gate", "off");
  if (text == "off") return std::nullopt;
  double probability = 0.0;
  if (const auto number = ParseNumber(text)) {
    probability = *number;
  } else {
    probability = map->Number("gate", Quantity::kRatio);
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    map->Fail("gate", "'" + text +
                          "' is not a probability; expected off, or a value "
                          "between 0 and 1, such as 99.9 %");
  }
  map->Resolve("gate", probability, Quantity::kRatio);
  return probability;
}

void ReadCalibrationSigmas(ConfigMap* map, Sensor* sensor) {
  ConfigMap estimate = map->Map("estimate");
  if (HasLeverArm(sensor->type)) {
    sensor->lever_arm_sigma =
        estimate.OptionalSigma("lever_arm", Quantity::kLength);
  }
  const bool scaled = sensor->type == SensorType::kOdometer ||
                      sensor->type == SensorType::kDvl ||
                      sensor->type == SensorType::kAcousticFix;
  if (scaled || sensor->type == SensorType::kNonHolonomic) {
    sensor->mounting_sigma =
        estimate.OptionalSigma("mounting", Quantity::kAngle);
    if (sensor->mounting_unknown && !sensor->mounting_sigma) {
      sensor->mounting_sigma = Eigen::Vector3d::Constant(kFoundMountingSigma);
      map->resolved()["estimate"]["mounting"] =
          FormatNumber(kFoundMountingSigma) + " rad";
    }
  }
  if (scaled && estimate.Has("scale")) {
    sensor->scale_sigma = estimate.Positive("scale", Quantity::kRatio);
  }
  if (sensor->type == SensorType::kMagnetometer) {
    ReadMagneticEstimates(&estimate, &sensor->magnetic);
  }
  if (sensor->type == SensorType::kHeight && estimate.Has("offset")) {
    sensor->offset_sigma = estimate.Positive("offset", Quantity::kLength);
  }
  // What is generated at the IMU's own times has no clock to be estimated, and
  // what stands still shows none.
  if (sensor->type != SensorType::kNonHolonomic &&
      sensor->type != SensorType::kZeroVelocity &&
      estimate.Has("time_offset")) {
    sensor->time_offset_sigma =
        estimate.Positive("time_offset", Quantity::kTime);
  }
  estimate.Finish();
}

AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder) {
  AidingConfig config;
  const AidingType& type = ReadType(map);
  config.sensor.name = name;
  config.sensor.type = type.type;
  config.options.type = type.type;
  if (type.type == SensorType::kNonHolonomic) {
    config.source.name = map->name();
    config.source.config_path = map->file();
    config.source.config_line = map->Line("rate");
  } else {
    config.source = ReadStreamSource(map, folder, type.fields());
    config.options.accept_quality = ReadQualities(map);
    if (map->Has("every")) {
      config.options.every = map->Positive("every", Quantity::kTime);
    }
    config.clock_of_truth = map->Is("time_offset", "truth");
    config.clock_unknown = map->Is("time_offset", "unknown");
    if (!config.clock_of_truth && !config.clock_unknown) {
      config.sensor.time_offset =
          map->Number("time_offset", Quantity::kTime, 0.0);
    }
  }
  if (type.type == SensorType::kOdometer ||
      type.type == SensorType::kNonHolonomic) {
    ReadVehicle(map, &config);
  } else if (type.type == SensorType::kMagnetometer) {
    ReadMagnetometer(map, &config);
  } else if (type.type == SensorType::kDvl) {
    ReadDvl(map, &config.sensor, &config.options.dvl);
    config.options.has_current = config.sensor.current_sigma.has_value();
  } else if (type.type == SensorType::kAcousticFix) {
    ReadAcoustic(map, &config.sensor, &config.options.acoustic);
  } else if (type.type == SensorType::kZeroVelocity) {
    config.options.sigma.emplace().setConstant(
        map->Positive("sigma", type.sigma));
  } else {
    ReadSigmas(map, type, &config.options);
  }
  if (type.fields == DepthFields) {
    config.options.surface = map->Number("surface", Quantity::kLength, 0.0);
  }
  if (HasLeverArm(type.type)) {
    config.sensor.lever_arm_b =
        map->Vector("lever_arm", Quantity::kLength, Eigen::Vector3d::Zero());
  }
  config.sensor.gate_probability = ReadGate(map);
  config.sensor.loss = ReadLoss(map);
  ReadNoise(map, &config);
  ReadCalibrationSigmas(map, &config.sensor);
  if (config.clock_unknown && config.sensor.time_offset_sigma) {
    map->Fail("estimate",
              "time_offset does not go with `time_offset: unknown`, which is "
              "estimated as it is; expected a value of time_offset that the "
              "sigma belongs to, or no sigma");
  }
  if (config.sensor.offset_sigma &&
      config.sensor.noise.kind == NoiseModel::Kind::kGaussMarkov) {
    map->Fail("estimate", "offset does not go with correlated noise");
  }
  map->Finish();
  return config;
}

}  // namespace hindsight
