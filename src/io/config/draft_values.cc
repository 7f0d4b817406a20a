#include "io/config/draft_values.h"

#include <string>
#include <variant>
#include <vector>

#include "io/read/column_lines.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// A value that is usual of a key that must be given.
std::string UsualValue(const SensorKey& key) {
  if (std::holds_alternative<SensorKey::Place>(key.value)) {
    return "[0 deg, 0 deg, 0 m]";
  }
  std::string value = "1";
  switch (key.quantity) {
    case Quantity::kLength:
      value = "2 m";
      break;
    case Quantity::kSpeed:
      value = "0.2 m/s";
      break;
    case Quantity::kAngle:
      value = "2 deg";
      break;
    case Quantity::kRatio:
      break;
    default:
      value += std::string(" ") + SiUnit(key.quantity);
  }
  const bool three = std::holds_alternative<SensorKey::Vector>(key.value);
  return three ? "[" + value + ", " + value + ", " + value + "]" : value;
}

/// What suits a kind of sensor where its file says nothing.
std::vector<KeyLine> UsualLines(const SensorKind& kind, bool sigmas) {
  std::vector<KeyLine> lines;
  if (kind.is_position) {
    if (!sigmas) {
      lines.push_back(SlowFixNoise(2.0, 0.1,
                                   "the file states none; usual of a single "
                                   "receiver (a guess)"));
    }
    lines.push_back({"estimate", "{lever_arm: 1 m, time_offset: 0.5 s}",
                     "lever_arm is from the IMU: forward, right, down"});
  } else if (kind.is_velocity) {
    if (!sigmas) lines.push_back({"sigma", "0.2 m/s", "usual (a guess)"});
    lines.push_back({"estimate", "{lever_arm: 1 m, time_offset: 0.5 s}"});
  } else if (&kind == &SpeedCourseKind()) {
    lines.push_back({"sigma", "0.2 m/s", "usual (a guess)"});
    lines.push_back({"course_sigma", "2 deg", "usual (a guess)"});
    lines.push_back({"course_above", "2 m/s"});
    lines.push_back({"estimate", "{time_offset: 0.5 s}"});
  } else if (&kind == &OdometerKind()) {
    lines.push_back({"sigma", "[0.1, 0.2, 0.3 m/s]",
                     "with no slip to the side or up (a guess)"});
    lines.push_back({"estimate",
                     "{scale: 5 %, mounting: 10 deg, lever_arm: 1 m, "
                     "time_offset: 0.1 s}"});
  } else if (&kind == &DvlKind()) {
    lines.push_back({"sigma", "1 cm/s", "usual (a guess)"});
    lines.push_back(
        {"estimate",
         "{scale: 1 %, mounting: 3 deg, lever_arm: 1 m, time_offset: 0.5 s}"});
  } else if (&kind == &HeightKind()) {
    lines.push_back({"estimate", "{offset: 50 m}",
                     "of geoid and weather: what a barometer starts from"});
  } else if (kind.standing) {
    lines.push_back({"sigma", "5 cm/s", "of a foot that rolls (a guess)"});
  } else if (kind.magnetic) {
    lines.push_back({"form", "vector"});
    lines.push_back({"sigma", "2 uT",
                     "of an error that lasts a second, indoors (a guess)"});
    lines.push_back({"horizontal", "20 uT", "(a guess)"});
    lines.push_back({"down", "44 uT", "(a guess)"});
  }
  return lines;
}

}  // namespace

void CompleteStream(bool axes_known, StreamDraft* stream) {
  std::vector<KeyLine>& lines = stream->found.lines;
  const SensorKind& kind = *stream->kind;
  const FoundStream& found = stream->found;
  const bool own_noise = FindLine(lines, "noise") != nullptr;
  const SensorSettings settings = SettingsOf(kind);
  const bool sigmas =
      found.sigmas && !own_noise && kind.measured(settings).sigmas > 0;
  const auto add = [&](const KeyLine& line) {
    if (FindLine(lines, line.key) == nullptr) lines.push_back(line);
  };
  const bool fast = found.stamps && found.stamps->step < 0.9;
  if ((kind.is_position || &kind == &SpeedCourseKind()) && fast) {
    add({"every", "1 s", "errors of neighbouring fixes are alike"});
  }
  if (&kind == &OdometerKind() && found.stamps && found.stamps->step < 0.09) {
    add({"every", "0.1 s"});
  }
  const bool increments = FindLine(lines, "form") != nullptr;
  if (!increments) {
    for (const KeyLine& line : UsualLines(kind, sigmas)) add(line);
  }
  if (kind.magnetic && !axes_known) {
    add({"axes", "[x, y, z]"});
  }
  for (const SensorKey& key : kind.keys) {
    if (key.applies != nullptr && !key.applies(settings)) continue;
    const bool unstated = key.name == "sigma" && !sigmas && !own_noise &&
                          FindLine(lines, "noise") == nullptr;
    if (unstated || (key.needed != nullptr && key.needed(settings))) {
      add({std::string(key.name), UsualValue(key), "usual (a guess)"});
    }
  }
}

}  // namespace hindsight
