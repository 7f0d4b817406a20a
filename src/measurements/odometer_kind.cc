#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "measurements/axle.h"
#include "measurements/odometer.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Form = Odometer::Form;

Form FormOf(const SensorSettings& settings) {
  return PatternOf<Odometer>(settings).form;
}
bool CountsDistance(const SensorSettings& settings) {
  return FormOf(settings) == Form::kIncrements;
}
bool MeasuresSpeed(const SensorSettings& settings) {
  return FormOf(settings) != Form::kIncrements;
}

constexpr Form kForms[] = {Form::kThreeAxis, Form::kForward, Form::kIncrements};

std::size_t IndexOfForm(const SensorSettings& settings) {
  return static_cast<std::size_t>(
      std::find(std::begin(kForms), std::end(kForms), FormOf(settings)) -
      std::begin(kForms));
}

/// Column of the count.
constexpr std::size_t kDistance = 4;

std::optional<MeasurementModel> ReadOdometer(const MeasuredRow& row,
                                             const SensorSettings& settings) {
  Odometer odometer = PatternOf<Odometer>(settings);
  if (odometer.form == Form::kIncrements) {
    odometer.distance = row.Value(kDistance);
    return odometer;
  }
  odometer.speed = row.Value(0);
  if (row.Has(1)) odometer.side_down.x() = row.Value(1);
  if (row.Has(2)) odometer.side_down.y() = row.Value(2);
  return odometer;
}

/// From counts to what has come since the count before; the first has none.
void TakeDifferences(const SensorSettings& settings,
                     MeasurementSeries* measurements) {
  if (!CountsDistance(settings)) return;
  Measurement before;
  for (Measurement& z : measurements->Edited()) {
    const Measurement count = z;
    auto& here = std::get<Odometer>(z.model);
    if (const auto* from = std::get_if<Odometer>(&before.model)) {
      here.distance -= from->distance;
      here.t_from = before.t;
    }
    before = count;
  }
  bool first = true;
  measurements->EraseIf(
      [&](const Measurement&) { return std::exchange(first, false); });
}

/// Increments as a count that stands still where one is missing.
MeasurementSeries AddUp(const MeasurementSeries& increments) {
  const Measurement first = increments.front();
  if (std::get<Odometer>(first.model).form != Form::kIncrements) {
    return increments;
  }
  MeasurementSeries counts;
  double count = 0.0;
  double t = -std::numeric_limits<double>::infinity();
  for (Measurement z : increments) {
    auto& odometer = std::get<Odometer>(z.model);
    const double end = z.t;
    const double increment = odometer.distance;
    if (odometer.t_from > t) {
      z.t = odometer.t_from;
      odometer.distance = count;
      counts.push_back(z);
    }
    count += increment;
    odometer.distance = count;
    z.t = t = end;
    counts.push_back(z);
  }
  return counts;
}

std::vector<WrittenColumn> OdometerColumns(const MeasurementModel& z,
                                           const Sensor&) {
  if (std::get<Odometer>(z).form == Form::kIncrements) {
    return {{"distance", "m"}};
  }
  return {{"speed", "m/s"}, {"side", "m/s"}, {"down", "m/s"}};
}

std::vector<double> WriteOdometer(const MeasurementModel& z, const Sensor&) {
  const auto& odometer = std::get<Odometer>(z);
  if (odometer.form == Form::kIncrements) return {odometer.distance};
  return {odometer.speed, odometer.side_down.x(), odometer.side_down.y()};
}

std::optional<MeasurementModel> PerfectOdometer(const SensorSettings& settings,
                                                const Motion& motion) {
  Odometer odometer = PatternOf<Odometer>(settings);
  odometer.speed = PerfectVelocity(settings.sensor, motion).x();
  return odometer;
}

void DisturbOdometers(const SensorSettings& settings, Random* random,
                      std::vector<Measurement>* measurements) {
  const double count_sigma = settings.sensor.count_sigma;
  const double scale = 1.0 + settings.truth.scale;
  double count_error = count_sigma > 0.0 ? count_sigma * random->Normal() : 0.0;
  for (Measurement& z : *measurements) {
    auto& odometer = std::get<Odometer>(z.model);
    const Eigen::Vector3d error =
        odometer.sigma.cwiseProduct(random->NormalVector3());
    if (odometer.form == Form::kIncrements) {
      odometer.distance = scale * odometer.distance + error.x() - count_error;
      if (count_sigma <= 0.0) continue;
      count_error = count_sigma * random->Normal();
      odometer.distance += count_error;
      continue;
    }
    odometer.speed = scale * odometer.speed + error.x();
    odometer.side_down += error.tail<2>();
  }
}

bool IsCount(const MeasurementModel* z) {
  const auto* odometer = z == nullptr ? nullptr : std::get_if<Odometer>(z);
  return odometer != nullptr && odometer->form == Form::kIncrements;
}

/// Travelled since the last count.
SensorBlock DistanceBlock() {
  return {.kind = BlockKind::kDistance,
          .name = "distance",
          .unit = "m",
          .sigma =
              [](const Sensor&, const MeasurementModel* first) {
                constexpr double kAny = 1.0;  // forgotten at the first count
                return IsCount(first) ? OnAllAxes(kAny) : std::nullopt;
              },
          .evolution = [](const Sensor&) { return Evolution::Navigation(); }};
}

/// Of each count on its own: white, which is a correlation time below any
/// interval.
SensorBlock CountErrorBlock() {
  return {.kind = BlockKind::kOffset,
          .name = "count_error",
          .unit = "m",
          .sigma =
              [](const Sensor& sensor, const MeasurementModel* first) {
                return IsCount(first) && sensor.count_sigma > 0.0
                           ? OnAllAxes(sensor.count_sigma)
                           : std::nullopt;
              },
          .evolution =
              [](const Sensor& sensor) {
                constexpr double kNoTime = 1e-6;  // [s]
                return Evolution::GaussMarkov(sensor.count_sigma, kNoTime);
              }};
}

}  // namespace

const SensorKind& OdometerKind() {
  static const SensorKind kKind = {
      .name = "odometer",
      .help = "speed or counted distance along a vehicle's track",
      .residual_unit = "m/s",
      .of_vehicle = true,
      .in_vehicle_axes = true,
      .columns = AxleColumns(),
      .measured =
          [](const SensorSettings& settings) {
            return CountsDistance(settings) ? MeasuredColumns{kDistance, 1, 0}
                                            : MeasuredColumns{0, 1, 0};
          },
      .keys =
          {{.name = "form",
            .value = SensorKey::Word{{"three_axis", "forward", "increments"},
                                     IndexOfForm,
                                     [](SensorSettings& s, std::size_t i) {
                                       PatternOf<Odometer>(s).form = kForms[i];
                                     }},
            .help = "speed with zero side and down speed, speed alone, or the "
                    "distance since the count before, from a column `distance` "
                    "that counts up"},
           ScaleKey(),
           {.name = "sigma",
            .quantity = Quantity::kLength,
            .value =
                SensorKey::OptionalSigmas{
                    [](SensorSettings& s) { return &s.sigma; }, true},
            .help =
                "of one increment, independent of the others (ground, slip)",
            .applies = CountsDistance,
            .when = "form: increments",
            .needed = Always},
           {.name = "count_sigma",
            .quantity = Quantity::kLength,
            .value = SensorKey::Number{[](SensorSettings& s) {
                                         return &s.sensor.count_sigma;
                                       },
                                       SensorKey::Range::kNotNegative},
            .help = "of one count, whose error the next does not inherit "
                    "(resolution/sqrt(12))",
            .applies = CountsDistance,
            .when = "form: increments"},
           {.name = "sigma",
            .quantity = Quantity::kSpeed,
            .value = SensorKey::OptionalSigmas{[](SensorSettings& s) {
              return &s.sigma;
            }},
            .help = "forward, side, down, or one",
            .applies = MeasuresSpeed,
            .when = "form: three_axis or forward",
            .needed = Always,
            .missing = kAxleSigmaMissing},
           AxleLevelKey(),
           MountingKey(true),
           LeverArmKey(),
           LeverArmSigmaKey(),
           MountingSigmaKey(),
           ScaleSigmaKey()},
      .blocks = {ScaleBlock(), MountingBlock(), LeverArmBlock(),
                 DistanceBlock(), CountErrorBlock(), TimeOffsetBlock()},
      .prepare = [](SensorSettings* s) { s->pattern = Odometer(); },
      .complete = TakeAxleSigma,
      .uncomplete = GiveAxleSigma,
      .read = ReadOdometer,
      .join = TakeDifferences,
      .split = AddUp,
      .written = OdometerColumns,
      .write = WriteOdometer,
      .perfect = PerfectOdometer,
      .counts = CountsDistance,
      .set_count =
          [](double t_from, double count, MeasurementModel* z) {
            auto& odometer = std::get<Odometer>(*z);
            odometer.t_from = t_from;
            odometer.distance = count;
          },
      .count_rate =
          [](const SensorSettings& settings, const Motion& motion) {
            return PerfectVelocity(settings.sensor, motion).x();
          },
      .disturb = DisturbOdometers,
  };
  return kKind;
}

}  // namespace hindsight
