#include "io/read/units.h"

#include <fast_float/fast_float.h>

#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "io/read/unit_grammar.h"

namespace hindsight {
namespace {

struct QuantityText {
  const char* name;
  const char* si;
  const char* examples;
};

const QuantityText& Describe(Quantity quantity) {
  static constexpr std::array<QuantityText, 14> kTable = {{
      {"ratio", "1", "1, %, ppm"},
      {"time", "s", "s, ms, us, ns, min, h"},
      {"frequency", "Hz", "Hz, kHz"},
      {"length", "m", "m, mm, cm, km"},
      {"speed", "m/s", "m/s, cm/s, km/h, kn"},
      {"acceleration", "m/s^2", "m/s^2, g, mg, ug, mGal"},
      {"angle", "rad", "rad, mrad, deg, arcmin, arcsec"},
      {"angular rate", "rad/s", "rad/s, deg/s, deg/h"},
      {"gyro noise density", "rad/sqrt(s)",
       "deg/sqrt(h), deg/s/sqrt(Hz), deg/h/sqrt(Hz), rad/sqrt(s)"},
      {"accelerometer noise density", "m/s/sqrt(s)",
       "ug/sqrt(Hz), m/s/sqrt(h), m/s^2/sqrt(Hz)"},
      {"gyro bias walk", "rad/s/sqrt(s)",
       "deg/h/sqrt(h), deg/s/sqrt(s), deg/s^2/sqrt(Hz), rad/s/sqrt(s)"},
      {"accelerometer bias walk", "m/s^2/sqrt(s)",
       "ug/sqrt(s), mg/sqrt(h), ug/s/sqrt(Hz), m/s^2/sqrt(s)"},
      {"noise per rate", "sqrt(s)", "sqrt(s), 1/sqrt(Hz)"},
      {"magnetic field", "uT", "uT, nT, mG, G"},
  }};
  return kTable[static_cast<std::size_t>(quantity)];
}

/// Length of the number at the start of `text`.
std::size_t NumberLength(std::string_view text) {
  const std::size_t skip = text.starts_with('+') ? 1 : 0;
  double value = 0.0;
  const auto result = fast_float::from_chars(text.data() + skip,
                                             text.data() + text.size(), value);
  if (result.ec != std::errc()) return 0;
  return static_cast<std::size_t>(result.ptr - text.data());
}

/// "a length", "an angle".
std::string WithArticle(Quantity quantity) {
  const std::string name = Describe(quantity).name;
  return (name.starts_with('a') ? "an " : "a ") + name;
}

[[noreturn]] void Fail(std::string_view text, const std::string& what,
                       Quantity quantity) {
  throw std::invalid_argument("'" + std::string(text) + "' " + what +
                              "; expected " + WithArticle(quantity) +
                              " in one of " + UnitExamples(quantity));
}

std::optional<double> FactorOfUnit(std::string_view unit, Quantity quantity) {
  const auto meaning = MeaningOfUnit(unit);
  const auto si = MeaningOfUnit(SiUnit(quantity));
  if (!meaning || meaning->dimension != si->dimension) return std::nullopt;
  return meaning->factor;
}

double Convert(std::string_view text, std::string_view number,
               std::string_view unit, Quantity quantity) {
  const auto value = ParseNumber(number);
  if (!value) Fail(text, "does not start with a finite number", quantity);
  if (unit.empty()) Fail(text, "has no unit", quantity);
  const auto factor = FactorOfUnit(unit, quantity);
  if (!factor) {
    Fail(text,
         std::string("has the unit '") + std::string(unit) +
             "', which is not one of " + WithArticle(quantity),
         quantity);
  }
  return *value * *factor;
}

}  // namespace

const char* SiUnit(Quantity quantity) { return Describe(quantity).si; }

const char* UnitExamples(Quantity quantity) {
  return Describe(quantity).examples;
}

std::optional<double> UnitFactor(std::string_view unit, Quantity quantity) {
  const std::string_view trimmed = Trim(unit);
  const std::size_t length = NumberLength(trimmed);
  const std::string_view rest = Trim(trimmed.substr(length));
  const auto multiple = ParseNumber(trimmed.substr(0, length));
  if (!multiple || !(*multiple > 0.0) || rest.empty() ||
      std::isalpha(static_cast<unsigned char>(rest.front())) == 0) {
    return FactorOfUnit(unit, quantity);
  }
  const auto factor = FactorOfUnit(rest, quantity);
  if (factor) return *multiple * *factor;
  return std::nullopt;
}

double ParseQuantity(std::string_view text, Quantity quantity) {
  const std::string_view trimmed = Trim(text);
  const std::size_t length = NumberLength(trimmed);
  return Convert(text, trimmed.substr(0, length), Trim(trimmed.substr(length)),
                 quantity);
}

std::vector<double> ParseQuantities(std::string_view text, Quantity quantity) {
  std::string_view list = Trim(text);
  std::string_view common_unit;
  if (list.starts_with('[')) {
    const std::size_t close = list.find(']');
    if (close == list.npos) Fail(text, "has no closing ']'", quantity);
    common_unit = Trim(list.substr(close + 1));
    list = list.substr(1, close - 1);
  }
  if (common_unit.empty()) {
    const std::string_view last = Trim(list.substr(list.rfind(',') + 1));
    common_unit = Trim(last.substr(NumberLength(last)));
  }
  std::vector<double> values;
  while (true) {
    const std::size_t comma = std::min(list.find(','), list.size());
    const std::string_view item = Trim(list.substr(0, comma));
    const std::size_t length = NumberLength(item);
    const std::string_view unit = Trim(item.substr(length));
    values.push_back(Convert(text, item.substr(0, length),
                             unit.empty() ? common_unit : unit, quantity));
    if (comma == list.size()) return values;
    list.remove_prefix(comma + 1);
  }
}

std::string_view Trim(std::string_view text) {
  // By hand: find_first_not_of looks each character up in the set by a call.
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> ParseNumber(std::string_view text) {
  double value = 0.0;
  if (!ReadNumber(text, &value)) return std::nullopt;
  return value;
}

bool ReadNumber(std::string_view text, double* value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto result = fast_float::from_chars(text.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end && std::isfinite(*value);
}

}  // namespace hindsight
