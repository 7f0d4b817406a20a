#include "io/config/config_key.h"

#include <fmt/core.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {

bool LiesIn(KeyRange range, double value) {
  if (!std::isfinite(value)) return false;
  switch (range) {
    case KeyRange::kAny:
      return true;
    case KeyRange::kPositive:
      return value > 0.0;
    case KeyRange::kNotNegative:
      return value >= 0.0;
    case KeyRange::kScale:
      return value > -1.0;
  }
  return false;
}

namespace {

const char* Demand(KeyRange range) {
  switch (range) {
    case KeyRange::kPositive:
      return "must be greater than zero";
    case KeyRange::kNotNegative:
      return "must not be negative";
    case KeyRange::kScale:
      return "expected more than -100 %: measured = (1 + scale) true";
    case KeyRange::kAny:
      break;
  }
  return "must be finite";
}

std::string WithUnit(const std::string& text, Quantity quantity) {
  const std::string unit = SiUnit(quantity);
  return unit == "1" ? text : text + " " + unit;
}

}  // namespace

double ReadInRange(ConfigMap* map, const std::string& name, Quantity quantity,
                   KeyRange range) {
  const double value = map->Number(name, quantity);
  if (!LiesIn(range, value)) map->Fail(name, Demand(range));
  return value;
}

void RequireOnBoard(const ConfigMap& map, const std::string& name,
                    Quantity quantity, const Eigen::Vector3d& value) {
  constexpr double kLongest = 1000.0;  // [m]
  if (quantity != Quantity::kLength || value.norm() <= kLongest) return;
  map.Fail(name, fmt::format("is {:.4g} m long; expected at most {:.0f} m from "
                             "the IMU",
                             value.norm(), kLongest));
}

std::string DefaultText(double value, Quantity quantity) {
  if (!std::isfinite(value)) return "-";
  if (quantity == Quantity::kAngle) {
    return FormatNumber(std::round(value / kDegree * 1e9) / 1e9) + " deg";
  }
  return WithUnit(FormatNumber(value), quantity);
}

std::string DefaultText(const Eigen::Vector3d& value, Quantity quantity) {
  return "[" + FormatNumber(value.x()) + ", " + FormatNumber(value.y()) + ", " +
         WithUnit(FormatNumber(value.z()), quantity) + "]";
}

std::string MeaningOf(const std::vector<std::string>& words,
                      std::string_view help) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  if (!text.empty() && !help.empty()) text += ": ";
  return text + std::string(help);
}

}  // namespace hindsight
