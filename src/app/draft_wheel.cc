#include "app/draft_wheel.h"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "dataset/wheel_speed.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Radius and direction of a wheel whose rate was taken times a usual radius, and
/// the clock of an IMU on it.
void TellRadius(const WheelComparison& wheel, StreamDraft* drafted) {
  std::vector<KeyLine>& lines = drafted->found.lines;
  const KeyLine* speed = FindLine(lines, "  speed");
  const std::size_t at = speed->value.find("scale: ") + 7;
  const double scale = std::stod(speed->value.substr(at)) * wheel.factor;
  SetLine(
      {"  speed", speed->value.substr(0, at) + fmt::format("{:.6g}}}", scale),
       fmt::format("a wheel of {:.3f} m radius, by the speed of the "
                   "positions, correlation {:.3f} (likely)",
                   std::abs(kUsualWheelRadius * wheel.factor),
                   wheel.correlation)},
      &lines);
  if (!drafted->found.spin_axis) return;
  SetLine({"time_offset", fmt::format("{:.2f} s", wheel.offset),
           "by the speed of the positions (likely)"},
          &lines);
}

/// Of a speed in m/s that has no unit.
std::string UnitOf(double factor) {
  constexpr double kNear = 0.05;
  for (const char* unit : {"m/s", "km/h", "mph", "kn", "cm/s", "mm/s"}) {
    const double known = *UnitFactor(unit, Quantity::kSpeed);
    if (std::abs(factor / known - 1.0) < kNear) return unit;
  }
  return "";
}

bool TellUnitAndSign(const WheelComparison& wheel, StreamDraft* drafted,
                     RecordingDraft* draft) {
  KeyLine speed = *FindLine(drafted->found.lines, "  speed");
  const bool told = drafted->found.speed_unit_told;
  const bool back = wheel.factor < 0.0;
  const std::string unit = told ? "" : UnitOf(std::abs(wheel.factor));
  const bool same = told || unit == "m/s";
  if (!speed.value.starts_with('"') || (same && !back)) return false;
  const std::size_t open = speed.value.find(" [");
  const std::string column = speed.value.substr(1, open - 1);
  const std::string sign = back ? "-" : "";
  if (same) {
    speed.value.insert(1, sign);
  } else if (!unit.empty()) {
    speed.value = fmt::format("\"{}{} [{}]\"", sign, column, unit);
  } else {
    speed.value = fmt::format("{{column: \"{}\", unit: m/s, scale: {:.6g}}}",
                              column, wheel.factor);
    draft->Assume(drafted->name +
                  ": its unit is not stated; it is scaled to the speed of the "
                  "positions");
  }
  speed.comment += fmt::format(
      "{}by the speed of the positions, correlation {:.3f} (likely)",
      speed.comment.empty() ? "" : "; ", wheel.correlation);
  if (back) {
    draft->Assume(drafted->name +
                  ": it reads negative speeds where the vehicle is taken to "
                  "drive forward: its sign is turned");
  }
  SetLine(std::move(speed), &drafted->found.lines);
  return true;
}

}  // namespace

bool TellWheels(const Dataset& dataset, RecordingDraft* draft) {
  bool changed = false;
  for (const AidingStream& stream : dataset.streams) {
    StreamDraft* drafted = draft->Find(stream.sensor.name);
    if (drafted == nullptr || drafted->kind != &OdometerKind() ||
        FindLine(drafted->found.lines, "  speed") == nullptr) {
      continue;
    }
    const bool rate = drafted->found.wheel_rate;
    const auto wheel = FindWheel(stream, dataset);
    if (wheel && rate) {
      TellRadius(*wheel, drafted);
      changed = true;
    } else if (wheel) {
      changed = TellUnitAndSign(*wheel, drafted, draft) || changed;
    } else if (rate) {
      draft->Assume(drafted->name +
                    ": no position shows the radius of the wheel");
    }
  }
  return changed;
}

}  // namespace hindsight
