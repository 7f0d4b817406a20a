#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/units.h"
#include "earth/wgs84.h"
#include "measurements/dvl.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

bool HasBeams(const SensorSettings& settings) {
  return PatternOf<Dvl>(settings).form == Dvl::Form::kBeams;
}
bool HasAxes(const SensorSettings& settings) { return !HasBeams(settings); }
bool TracksWater(const SensorSettings& settings) {
  return PatternOf<Dvl>(settings).water;
}

/// Columns of the flags of the beams, and of the track.
constexpr std::size_t kValid = 7;
constexpr std::size_t kWater = 11;

std::optional<KeyObjection> CompleteDvl(SensorSettings* settings) {
  Dvl& dvl = PatternOf<Dvl>(*settings);
  if (settings->sigma) {
    dvl.sigma.setConstant(HasBeams(*settings) ? settings->sigma->x() : 1.0);
    if (!HasBeams(*settings)) dvl.sigma.head<3>() = *settings->sigma;
  }
  if (HasBeams(*settings) && dvl.beam_angle >= 0.5 * kPi) {
    return KeyObjection{"beam_angle", "must be less than 90 deg"};
  }
  const Sensor& sensor = settings->sensor;
  if (std::isfinite(sensor.current_tau) &&
      std::isfinite(sensor.current_length)) {
    return KeyObjection{"current.length", "does not go with time"};
  }
  return std::nullopt;
}

std::optional<MeasurementModel> ReadDvl(const MeasuredRow& row,
                                        const SensorSettings& settings) {
  Dvl dvl = PatternOf<Dvl>(settings);
  const std::size_t first = HasBeams(settings) ? 3 : 0;
  for (int i = 0; i < dvl.components(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    dvl.speed(i) = row.Value(first + k);
    dvl.valid[k] = std::isfinite(dvl.speed(i)) &&
                   (!row.Has(kValid + k) || row.Flag(kValid + k));
  }
  if (row.Has(kWater)) dvl.water = row.Flag(kWater);
  if (dvl.water && !settings.sensor.current_sigma) {
    row.Fail(settings.sensor.name +
             ": water track needs `current` in the configuration");
  }
  if (dvl.rows() == 0) return std::nullopt;
  return dvl;
}

std::vector<WrittenColumn> DvlColumns(const MeasurementModel& z,
                                      const Sensor&) {
  if (std::get<Dvl>(z).form == Dvl::Form::kThreeAxis) {
    return {{"v_x", "m/s"}, {"v_y", "m/s"}, {"v_z", "m/s"}};
  }
  return {{"beam_1", "m/s"},         {"beam_2", "m/s"},
          {"beam_3", "m/s"},         {"beam_4", "m/s"},
          {"valid_1", "1", 1.0, -1}, {"valid_2", "1", 1.0, -1},
          {"valid_3", "1", 1.0, -1}, {"valid_4", "1", 1.0, -1}};
}

std::vector<double> WriteDvl(const MeasurementModel& z, const Sensor&) {
  const auto& dvl = std::get<Dvl>(z);
  std::vector<double> values(dvl.speed.begin(),
                             dvl.speed.begin() + dvl.components());
  if (dvl.form == Dvl::Form::kBeams) {
    for (const bool valid : dvl.valid) values.push_back(valid ? 1.0 : 0.0);
  }
  return values;
}

std::optional<MeasurementModel> PerfectDvl(const SensorSettings& settings,
                                           const Motion& motion) {
  Dvl dvl = PatternOf<Dvl>(settings);
  Motion through = motion;
  if (dvl.water) {
    through.v_e -= NedAxes(motion.p_e) * settings.truth.current_n;
  }
  const Eigen::Vector3d v_d = PerfectVelocity(settings.sensor, through);
  for (int i = 0; i < dvl.components(); ++i) {
    dvl.speed(i) = dvl.Direction(i).dot(v_d);
  }
  return dvl;
}

void DisturbDvls(const SensorSettings& settings, Random* random,
                 std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& dvl = std::get<Dvl>(z.model);
    for (int i = 0; i < dvl.components(); ++i) {
      dvl.speed(i) = (1.0 + settings.truth.scale) * dvl.speed(i) +
                     dvl.sigma(i) * random->Normal();
      if (settings.truth.beam_dropout > 0.0) {
        dvl.valid[static_cast<std::size_t>(i)] =
            random->Uniform() >= settings.truth.beam_dropout;
      }
    }
  }
}

SensorKeys DvlKeys() {
  return {
      {.name = "form",
       .value = SensorKey::Word{{"three_axis", "beams"},
                                [](const SensorSettings& s) {
                                  return std::size_t{HasBeams(s) ? 1U : 0U};
                                },
                                [](SensorSettings& s, std::size_t i) {
                                  PatternOf<Dvl>(s).form =
                                      i == 0 ? Dvl::Form::kThreeAxis
                                             : Dvl::Form::kBeams;
                                }},
       .help = "columns v_x, v_y, v_z, or beam_1 to beam_4, each of which may "
               "be absent or have a 0 in valid_1 to valid_4"},
      {.name = "beam_angle",
       .quantity = Quantity::kAngle,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &PatternOf<Dvl>(s).beam_angle;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "of the beams from the vertical",
       .applies = HasBeams,
       .when = "form: beams"},
      {.name = "beam_azimuth",
       .quantity = Quantity::kAngle,
       .value = SensorKey::Number{[](SensorSettings& s) {
         return &PatternOf<Dvl>(s).beam_azimuth;
       }},
       .help = "of the first beam, from forward to right",
       .applies = HasBeams,
       .when = "form: beams"},
      {.name = "sigma",
       .quantity = Quantity::kSpeed,
       .value =
           SensorKey::OptionalSigmas{[](SensorSettings& s) { return &s.sigma; },
                                     true},
       .help = "along a beam",
       .applies = HasBeams,
       .when = "form: beams",
       .needed = Always,
       .missing = "is missing; expected a standard deviation of a speed"},
      {.name = "sigma",
       .quantity = Quantity::kSpeed,
       .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
         return &s.sigma;
       }},
       .help = "forward, right, down, or one",
       .applies = HasAxes,
       .when = "form: three_axis",
       .needed = Always,
       .missing = "is missing; expected a standard deviation of a speed"},
      {.name = "track",
       .value = SensorKey::Word{{"bottom", "water"},
                                [](const SensorSettings& s) {
                                  return std::size_t{TracksWater(s) ? 1U : 0U};
                                },
                                [](SensorSettings& s, std::size_t i) {
                                  PatternOf<Dvl>(s).water = i == 1;
                                }},
       .help = "for rows where a column water (1, 0) does not say"},
      MountingKey(),
      ScaleKey(),
      {.name = "current.sigma",
       .quantity = Quantity::kSpeed,
       .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
         return &s.sensor.current_sigma;
       }},
       .help = "of each component of the water's current; water track needs it",
       .needed = TracksWater,
       .missing = "is missing; water track needs it: {sigma, time or length}"},
      {.name = "current.time",
       .quantity = Quantity::kTime,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.current_tau;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "over which the current is correlated, else it is constant"},
      {.name = "current.length",
       .quantity = Quantity::kLength,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.current_length;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "the same as a distance travelled"},
      {.name = "bias.sigma",
       .quantity = Quantity::kSpeed,
       .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
         return &s.sensor.bias.sigma;
       }},
       .help = "of a lasting error of each component, in its own axes: "
               "forward, right, down, or one"},
      {.name = "bias.time",
       .quantity = Quantity::kTime,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.bias.tau;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "over which it is correlated, else it is constant"},
      {.name = "ground_bias.sigma",
       .quantity = Quantity::kSpeed,
       .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
         return &s.sensor.ground_bias.sigma;
       }},
       .help = "of a lasting error of bottom track over the ground: north, "
               "east, down, or one"},
      {.name = "ground_bias.time",
       .quantity = Quantity::kTime,
       .value = SensorKey::Number{[](SensorSettings& s) {
                                    return &s.sensor.ground_bias.tau;
                                  },
                                  SensorKey::Range::kPositive},
       .help = "over which it is correlated, else it is constant"},
      {.name = "beam_dropout",
       .value = SensorKey::Number{[](SensorSettings& s) {
         return &s.truth.beam_dropout;
       }},
       .help = "probability that a ping loses a beam",
       .simulated = true},
      {.name = "true_current",
       .quantity = Quantity::kSpeed,
       .value = SensorKey::Vector{[](SensorSettings& s) {
         return &s.truth.current_n;
       }},
       .help = "of the water: north, east, down",
       .simulated = true},
      LeverArmKey(),
      LeverArmSigmaKey(),
      MountingSigmaKey(),
      ScaleSigmaKey()};
}

SensorBlock CurrentBlock() {
  return {.kind = BlockKind::kCurrent,
          .name = "current",
          .unit = "m/s",
          .sigma =
              [](const Sensor& sensor, const MeasurementModel*) {
                return OnAllAxes(sensor.current_sigma);
              },
          .evolution =
              [](const Sensor& sensor) {
                const double sigma = *sensor.current_sigma;
                if (std::isfinite(sensor.current_length)) {
                  return Evolution::SpatialGaussMarkov(sigma,
                                                       sensor.current_length);
                }
                if (std::isfinite(sensor.current_tau)) {
                  return Evolution::GaussMarkov(sigma, sensor.current_tau);
                }
                return Evolution::Constant();
              },
          .advice = "bottom track, position fixes, or turns both ways"};
}

Evolution EvolutionOf(const LastingError& error) {
  return std::isfinite(error.tau)
             ? Evolution::GaussMarkov(error.sigma->maxCoeff(), error.tau)
             : Evolution::Constant();
}

/// Of the state (ShareOf).
std::optional<Eigen::Vector3d> StateSigma(const LastingError& error) {
  if (!error.sigma || !std::isfinite(error.tau)) return error.sigma;
  return Eigen::Vector3d(Eigen::Vector3d::Constant(error.sigma->maxCoeff()));
}

SensorBlock BiasBlock() {
  return {
      .kind = BlockKind::kBias,
      .name = "bias",
      .unit = "m/s",
      .sigma = [](const Sensor& sensor,
                  const MeasurementModel*) { return StateSigma(sensor.bias); },
      .value = [](const Sensor& sensor) { return sensor.bias.value; },
      .evolution =
          [](const Sensor& sensor) { return EvolutionOf(sensor.bias); },
      .advice =
          "other speeds, as scale and mounting look the same at one, and "
          "position fixes, or turns both ways",
      .know =
          [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
             Sensor* sensor) {
            sensor->bias.value = value;
            sensor->bias.sigma = sigma;
          }};
}

SensorBlock GroundBiasBlock() {
  return {
      .kind = BlockKind::kGroundBias,
      .name = "ground_bias",
      .unit = "m/s",
      .sigma = [](const Sensor& sensor,
                  const MeasurementModel*) { return sensor.ground_bias.sigma; },
      .evolution =
          [](const Sensor& sensor) { return EvolutionOf(sensor.ground_bias); },
      .advice = "position fixes some way apart"};
}

void AddLastingErrors(const Eigen::Vector3d& bias_s,
                      const Eigen::Vector3d& ground_bias_s,
                      MeasurementModel* model) {
  auto& dvl = std::get<Dvl>(*model);
  const Eigen::Vector3d error =
      dvl.water ? bias_s : (bias_s + ground_bias_s).eval();
  for (int i = 0; i < dvl.components(); ++i) {
    dvl.speed(i) += dvl.Direction(i).dot(error);
  }
}

}  // namespace

const SensorKind& DvlKind() {
  static const SensorKind kKind = {
      .name = "dvl",
      .help = "Doppler velocity log: over the bottom or through the water",
      .residual_unit = "m/s",
      .in_vehicle_axes = true,
      .columns = {{"v_x", Quantity::kSpeed},
                  {"v_y", Quantity::kSpeed},
                  {"v_z", Quantity::kSpeed},
                  {"beam_1", Quantity::kSpeed},
                  {"beam_2", Quantity::kSpeed},
                  {"beam_3", Quantity::kSpeed},
                  {"beam_4", Quantity::kSpeed},
                  {"valid_1", Quantity::kRatio},
                  {"valid_2", Quantity::kRatio},
                  {"valid_3", Quantity::kRatio},
                  {"valid_4", Quantity::kRatio},
                  {"water", Quantity::kRatio},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings& settings) {
            return HasBeams(settings) ? MeasuredColumns{3, 4, 0}
                                      : MeasuredColumns{0, 3, 0};
          },
      .judges_absence = HasBeams,
      .forbidden =
          [](const SensorSettings& settings) {
            if (HasBeams(settings)) return SensorKind::Forbidden{};
            return SensorKind::Forbidden{
                kValid, kWater - kValid,
                " goes with `form: beams`; of three axes, expected `quality` "
                "with accept_quality"};
          },
      .keys = DvlKeys(),
      .blocks = {ScaleBlock(), MountingBlock(), LeverArmBlock(),
                 TimeOffsetBlock(), CurrentBlock(), BiasBlock(),
                 GroundBiasBlock()},
      .prepare =
          [](SensorSettings* s) {
            Dvl dvl;
            dvl.beam_angle = 30.0 * kDegree;
            dvl.beam_azimuth = 45.0 * kDegree;
            s->pattern = dvl;
          },
      .complete = CompleteDvl,
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma = PatternOf<Dvl>(*s).sigma.head<3>();
          },
      .read = ReadDvl,
      .unread = "row without a valid beam",
      .written = DvlColumns,
      .write = WriteDvl,
      .perfect = PerfectDvl,
      .add_lasting = AddLastingErrors,
      .disturb = DisturbDvls,
  };
  return kKind;
}

}  // namespace hindsight
