#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/units.h"
#include "earth/wgs84.h"
#include "measurements/magnetic_field.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

bool IsVector(const SensorSettings& settings) {
  return PatternOf<MagneticField>(settings).form ==
         MagneticField::Form::kVector;
}

bool HasDisturbance(const SensorSettings& settings) {
  return settings.sensor.magnetic.disturbance_sigma.has_value();
}

std::optional<MeasurementModel> ReadField(const MeasuredRow& row,
                                          const SensorSettings& settings) {
  MagneticField z = PatternOf<MagneticField>(settings);
  z.field_b =
      settings.C_bs * Eigen::Vector3d(row.Value(0), row.Value(1), row.Value(2));
  return z;
}

std::optional<MeasurementModel> PerfectField(const SensorSettings& settings,
                                             const Motion& motion) {
  const MagneticSurroundings& magnetic = settings.sensor.magnetic;
  const Eigen::Vector3d m_n(
      magnetic.horizontal * std::cos(magnetic.declination),
      magnetic.horizontal * std::sin(magnetic.declination), magnetic.down);
  MagneticField z = PatternOf<MagneticField>(settings);
  z.field_b = motion.q_eb.conjugate() * (NedAxes(motion.p_e) * m_n) +
              magnetic.hard_iron_b;
  return z;
}

void DisturbFields(const SensorSettings&, Random* random,
                   std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& field = std::get<MagneticField>(z.model);
    field.field_b += field.sigma * random->NormalVector3();
  }
}

SensorKeys MagnetometerKeys() {
  constexpr auto kMagnetic = Quantity::kMagneticField;
  return {
      {.name = "form",
       .value = SensorKey::Word{{"vector", "heading"},
                                [](const SensorSettings& s) {
                                  return std::size_t{IsVector(s) ? 0U : 1U};
                                },
                                [](SensorSettings& s, std::size_t i) {
                                  PatternOf<MagneticField>(s).form =
                                      i == 0 ? MagneticField::Form::kVector
                                             : MagneticField::Form::kHeading;
                                }},
       .help = "all of the field, or its azimuth alone"},
      {.name = "axes",
       .value = SensorKey::Axes{},
       .help = "and mounting, as of the imu"},
      NeededSigmaKey(kMagnetic, "of each axis"),
      {.name = "declination",
       .quantity = Quantity::kAngle,
       .value = SensorKey::Number{[](SensorSettings& s) {
         return &s.sensor.magnetic.declination;
       }},
       .help = "magnetic from true north, east positive"},
      {.name = "hard_iron",
       .quantity = kMagnetic,
       .value = SensorKey::Vector{[](SensorSettings& s) {
         return &s.sensor.magnetic.hard_iron_b;
       }},
       .help = "field of the vehicle itself, body axes"},
      {.name = "horizontal",
       .quantity = kMagnetic,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.magnetic.horizontal;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "horizontal part of the field",
       .needed = IsVector},
      {.name = "down",
       .quantity = kMagnetic,
       .value = SensorKey::Number{[](SensorSettings& s) {
         return &s.sensor.magnetic.down;
       }},
       .help = "downward part of the field",
       .applies = IsVector,
       .when = "form: vector",
       .needed = IsVector,
       .missing = "is missing; expected the field's downward component"},
      {.name = "estimate.hard_iron",
       .quantity = kMagnetic,
       .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
         return &s.sensor.magnetic.hard_iron_sigma;
       }},
       .help = "a priori sigma of an estimated one"},
      {.name = "estimate.declination",
       .quantity = Quantity::kAngle,
       .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
         return &s.sensor.magnetic.declination_sigma;
       }},
       .help = "a priori sigma of an estimated one"},
      {.name = "estimate.disturbance",
       .quantity = kMagnetic,
       .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
         return &s.sensor.magnetic.disturbance_sigma;
       }},
       .help = "sigma of a Gauss-Markov field in NED axes"},
      {.name = "estimate.disturbance_tau",
       .quantity = Quantity::kTime,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.magnetic.disturbance_tau;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "its correlation time",
       .applies = HasDisturbance,
       .when = "estimate.disturbance"}};
}

std::vector<SensorBlock> MagnetometerBlocks() {
  return {TimeOffsetBlock(),
          {.kind = BlockKind::kHardIron,
           .name = "hard_iron",
           .unit = "uT",
           .sigma =
               [](const Sensor& sensor, const MeasurementModel*) {
                 return sensor.magnetic.hard_iron_sigma;
               },
           .value =
               [](const Sensor& sensor) { return sensor.magnetic.hard_iron_b; },
           .know =
               [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
                  Sensor* sensor) {
                 sensor->magnetic.hard_iron_b = value;
                 sensor->magnetic.hard_iron_sigma = sigma;
               }},
          {.kind = BlockKind::kDeclination,
           .name = "declination",
           .unit = "rad",
           .sigma =
               [](const Sensor& sensor, const MeasurementModel*) {
                 return OnAllAxes(sensor.magnetic.declination_sigma);
               },
           .value =
               [](const Sensor& sensor) {
                 return Eigen::Vector3d(
                     Eigen::Vector3d::Constant(sensor.magnetic.declination));
               }},
          {.kind = BlockKind::kDisturbance,
           .name = "disturbance",
           .unit = "uT",
           .sigma =
               [](const Sensor& sensor, const MeasurementModel*) {
                 return OnAllAxes(sensor.magnetic.disturbance_sigma);
               },
           .evolution =
               [](const Sensor& sensor) {
                 return Evolution::GaussMarkov(
                     *sensor.magnetic.disturbance_sigma,
                     sensor.magnetic.disturbance_tau);
               },
           .searched =
               [](const Sensor&) {
                 return std::vector<NoiseValue>{
                     {"disturbance",
                      [](Sensor& s) { return &*s.magnetic.disturbance_sigma; }},
                     {"disturbance_tau",
                      [](Sensor& s) { return &s.magnetic.disturbance_tau; }}};
               }}};
}

}  // namespace

const SensorKind& MagnetometerKind() {
  static const SensorKind kKind = {
      .name = "magnetometer",
      .help = "the Earth's magnetic field",
      .magnetic = true,
      .columns = {{"mag_x", Quantity::kMagneticField},
                  {"mag_y", Quantity::kMagneticField},
                  {"mag_z", Quantity::kMagneticField},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 3, 0};
          },
      .keys = MagnetometerKeys(),
      .blocks = MagnetometerBlocks(),
      .prepare = [](SensorSettings* s) { s->pattern = MagneticField(); },
      .complete = [](SensorSettings* s) -> std::optional<KeyObjection> {
        PatternOf<MagneticField>(*s).sigma = s->sigma->x();
        if (std::abs(s->sensor.magnetic.declination) > kPi) {
          return KeyObjection{"declination", "expected -180 to 180 deg"};
        }
        return std::nullopt;
      },
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma.emplace().setConstant(PatternOf<MagneticField>(*s).sigma);
          },
      .read = ReadField,
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{
                {"mag_x", "uT"}, {"mag_y", "uT"}, {"mag_z", "uT"}};
          },
      .write =
          [](const MeasurementModel& z, const Sensor&) {
            const auto& field = std::get<MagneticField>(z).field_b;
            return std::vector<double>(field.begin(), field.end());
          },
      .perfect = PerfectField,
      .disturb = DisturbFields,
  };
  return kKind;
}

}  // namespace hindsight
