#include "problems/explanation_words.h"

#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "base/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr const char* kAxes[] = {"forward", "right", "down"};
constexpr const char* kNavigationAxes[] = {"north", "east", "down"};
/// A share of another axis that no calibration leaves.
constexpr double kPlainlyOfOthers = 0.1;
constexpr const char* kBodyAxes[] = {"x", "y", "z"};

/// An amount with the unit that people use.
std::string Amount(double value, std::string_view si) {
  if (si == "rad") return fmt::format("{:.2g} deg", value / kDegree);
  if (si == "rad/s") return fmt::format("{:.2g} deg/s", value / kDegree);
  if (si == "1") return fmt::format("{:.2g} %", 100.0 * value);
  return fmt::format("{:.2g}{}{}", value, si.empty() ? "" : " ", si);
}

std::string_view UnitOf(const ErrorLayout& layout, int component) {
  for (const Block& block : layout.blocks()) {
    if (component >= block.offset && component < block.offset + block.dim) {
      return block.unit;
    }
  }
  return "";
}

Words WordsOfBlock(const std::string& name, const Deviation& deviation,
                   double size) {
  const std::string axis = kAxes[deviation.axis];
  switch (deviation.block) {
    case BlockKind::kTimeOffset:
      return {fmt::format("{} is stamped {:.2g} s {}", name, std::abs(size),
                          size > 0.0 ? "early" : "late"),
              fmt::format("estimate.time_offset of {}", name)};
    case BlockKind::kScale:
      return {fmt::format("{} measures {} too {}", name,
                          Amount(std::abs(size), "1"),
                          size > 0.0 ? "much" : "little"),
              fmt::format("estimate.scale of {}", name)};
    case BlockKind::kLeverArm:
      return {fmt::format("{} stands {} more {} than its lever arm says", name,
                          Amount(size, "m"), axis),
              fmt::format("the lever_arm of {}, or estimate it", name)};
    case BlockKind::kMounting:
      return {fmt::format("{} is turned by {} about its {} axis", name,
                          Amount(size, "rad"), axis),
              fmt::format("the mounting of {}, or estimate it", name)};
    case BlockKind::kHardIron:
      return {fmt::format("the vehicle adds {} to {} ({})", Amount(size, "uT"),
                          name, axis),
              fmt::format("hard_iron of {}", name)};
    default:
      return {fmt::format("the declination of {} is {} larger", name,
                          Amount(size, "rad")),
              fmt::format("declination of {}", name)};
  }
}

std::string RowName(const Sensor& sensor, std::size_t row) {
  const auto& names = sensor.kind->components;
  return row < names.size() ? std::string(names[row]) : std::to_string(row + 1);
}

Words WordsOfDeviation(const Sensor& sensor, const Deviation& deviation,
                       double size) {
  const auto axis = static_cast<std::size_t>(deviation.axis);
  switch (deviation.kind) {
    case Deviation::Kind::kAdditive:
      return {fmt::format("{} [{}] is {} too {}", sensor.name,
                          RowName(sensor, axis),
                          Amount(std::abs(size), sensor.kind->residual_unit),
                          size > 0.0 ? "large" : "small"),
              "what " + sensor.name + " refers to, or a larger sigma"};
    case Deviation::Kind::kTurned:
      return {
          fmt::format("what {} measures is turned by {} about {}", sensor.name,
                      Amount(size, "rad"), kNavigationAxes[axis]),
          "the axes of " + sensor.name};
    case Deviation::Kind::kStretched:
      return {fmt::format("what {} measures is {} too {}", sensor.name,
                          Amount(std::abs(size), "1"),
                          size > 0.0 ? "large" : "small"),
              "the units of " + sensor.name};
    case Deviation::Kind::kBlock:
      return WordsOfBlock(sensor.name, deviation, size);
  }
  return {};
}

Words WordsOfImu(const ImuDeviation& deviation, double size) {
  const char* triad = deviation.of_gyros ? "gyro" : "accelerometer";
  const char* axis = kBodyAxes[deviation.axis];
  switch (deviation.kind) {
    case ImuDeviation::Kind::kScale:
      return {fmt::format("{} {} measures {} too {}", triad, axis,
                          Amount(std::abs(size), "1"),
                          size > 0.0 ? "much" : "little"),
              "unit, sign and scale of the IMU, or estimate its scale"};
    case ImuDeviation::Kind::kExchanged:
      return {
          fmt::format("{} {} and {} hold {} of each other", triad,
                      kBodyAxes[(deviation.axis + 1) % 3],
                      kBodyAxes[(deviation.axis + 2) % 3], Amount(size, "1")),
          std::abs(size) > kPlainlyOfOthers
              ? "the order of the IMU's columns"
              : "the alignment of the IMU's axes with each other"};
    case ImuDeviation::Kind::kTurned:
      return {fmt::format("the {}s are turned by {} about {} against the gyros",
                          triad, Amount(size, "rad"), axis),
              "order and signs of the IMU's columns"};
    case ImuDeviation::Kind::kLate:
      return {fmt::format("the {}s are {:.2g} s {} against the accelerometers",
                          triad, std::abs(size), size > 0.0 ? "late" : "early"),
              "the stamps of the IMU's columns, or a filter of one triad"};
  }
  return {};
}

}  // namespace

Words WordsOfShift(const MeanShift& shift, const DeviationColumns& own,
                   const Problem& problem) {
  const double size = shift.size();
  if (shift.of_state) {
    const Block* position = problem.layout.Find(BlockKind::kPosition);
    const bool is_place = shift.column >= position->offset &&
                          shift.column < position->offset + position->dim;
    return {fmt::format("{} jumps by {}",
                        problem.layout.ComponentName(shift.column),
                        Amount(size, UnitOf(problem.layout, shift.column))),
            is_place ? "an error that all sensors of places have in common, or "
                       "samples of the IMU that are lost"
                     : "a larger noise of what drives it"};
  }
  if (shift.group == DeviationColumns::kAllClocks) {
    return {fmt::format("the clock of the IMU runs {:.2g} s/s {} than all "
                        "others",
                        std::abs(size), size > 0.0 ? "faster" : "slower"),
            "time.rate or time.unit of the IMU"};
  }
  if (shift.group == DeviationColumns::kImu) {
    return WordsOfImu(ImuDeviations()[static_cast<std::size_t>(shift.column)],
                      size);
  }
  const Deviation& deviation =
      own.Of(shift.group)[static_cast<std::size_t>(shift.column)];
  Words words = WordsOfDeviation(
      problem.timeline.sensors()[static_cast<std::size_t>(shift.group)],
      deviation, size);
  if (shift.grows) words.what += " more each second";
  if (deviation.kind == Deviation::Kind::kBlock &&
      (shift.grows || shift.onset > 0)) {
    words.remedy =
        "a constant would not follow it: cut the recording there, or "
        "leave the sensor out";
  }
  return words;
}

Words WordsOfVarying(const MeanShift& shift, const DeviationColumns& own,
                     const Problem& problem) {
  const Sensor& sensor =
      problem.timeline.sensors()[static_cast<std::size_t>(shift.group)];
  const auto axis = static_cast<std::size_t>(
      own.Of(shift.group)[static_cast<std::size_t>(shift.column)].axis);
  return {fmt::format("errors of {} [{}] last longer than the time between "
                      "its measurements",
                      sensor.name, RowName(sensor, axis)),
          "noise: {model: gauss_markov, ...} of " + sensor.name};
}

}  // namespace hindsight
