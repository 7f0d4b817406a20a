#include "app/draft_turns.h"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "dataset/gyro_unit.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Whether a line names a column of the IMU, or of its accelerometers' own file.
bool IsColumnOf(const KeyLine& line, std::string_view family) {
  const std::size_t at = line.key.find_first_not_of(' ');
  if (at == std::string::npos || at == 0) return false;
  const std::string_view key = std::string_view(line.key).substr(at);
  return key.size() == family.size() + 1 && key.starts_with(family) &&
         key.back() >= 'x' && key.back() <= 'z';
}

void AddReason(const std::string& why, KeyLine* line) {
  line->comment += (line->comment.empty() ? "" : "; ") + why;
}

bool TakeUnit(const std::string& from, const std::string& to,
              RecordingDraft* draft) {
  bool changed = false;
  for (KeyLine& line : draft->imu->lines) {
    if (!IsColumnOf(line, "gyro_")) continue;
    for (const auto& [before, after] :
         {std::pair('[' + from + ']', '[' + to + ']'),
          {"unit: \"" + from + '"', "unit: \"" + to + '"'}}) {
      const std::size_t at = line.value.find(before);
      if (at == std::string::npos) continue;
      line.value.replace(at, before.size(), after);
      AddReason("the course turns as far in this unit (likely)", &line);
      changed = true;
    }
  }
  return changed;
}

/// The unit that is the factor `ratio` larger than the one of the draft.
bool TakeUnitOf(double ratio, RecordingDraft* draft) {
  const auto& guess = draft->imu->imu_guess;
  if (!guess || guess->gyro.certainty == Certainty::kCertain) return false;
  const auto now = UnitFactor(guess->gyro.unit, Quantity::kAngularRate);
  if (!now) return false;
  for (const char* unit : {"rad/s", "deg/s", "mrad/s", "mdeg/s"}) {
    const double factor = *UnitFactor(unit, Quantity::kAngularRate);
    if (unit != guess->gyro.unit && IsNearRatio(factor / *now, ratio)) {
      return TakeUnit(guess->gyro.unit, unit, draft);
    }
  }
  return false;
}

/// With a "-" before the column, or without one.
void Negate(KeyLine* line) {
  std::string& value = line->value;
  if (value.starts_with("\"-")) {
    value.erase(1, 1);
  } else if (value.starts_with('"')) {
    value.insert(1, "-");
  } else if (const std::size_t at = value.find("scale: ");
             at != std::string::npos) {
    const std::size_t number = at + 7;
    if (value[number] == '-') {
      value.erase(number, 1);
    } else {
      value.insert(number, "-");
    }
  } else {
    value.insert(value.size() - 1, ", scale: -1");
  }
}

void NegateAll(std::string_view family, RecordingDraft* draft) {
  for (KeyLine& line : draft->imu->lines) {
    if (!IsColumnOf(line, family)) continue;
    Negate(&line);
    AddReason("of the other sign (likely)", &line);
  }
}

/// How gravity turns tells which of the two it is, where it turns enough.
void TurnRound(RecordingDraft* draft) {
  constexpr double kShown = 0.5;
  const auto& guess = draft->imu->imu_guess;
  const double turn = guess ? guess->turn.correlation : 0.0;
  if (turn < 0.0) {
    NegateAll("gyro_", draft);
    draft->Assume(
        "imu: the gyros are taken for ones of the other sign: the course and "
        "gravity turn against them");
    return;
  }
  NegateAll("accel_", draft);
  draft->Assume(
      std::string("imu: the accelerometers are taken for ones that read -1 g "
                  "along the axis that points up, as phones and watches of "
                  "Apple do: the course turns against the gyros") +
      (turn > kShown ? ", and gravity with them"
                     : "; otherwise these have the other sign"));
}

}  // namespace

bool TellTurns(const Dataset& dataset, RecordingDraft* draft) {
  const auto ratio = CourseOverGyros(dataset);
  if (!ratio) return false;
  const bool scaled = !IsNearRatio(std::abs(*ratio), 1.0) &&
                      TakeUnitOf(std::abs(*ratio), draft);
  if (*ratio > 0.0) return scaled;
  TurnRound(draft);
  return true;
}

}  // namespace hindsight
