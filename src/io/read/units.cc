#include "io/read/units.h"

#include <fast_float/fast_float.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "base/units.h"

namespace hindsight {
namespace {

/// Exponents in halves, so that square roots stay integers.
struct Dimension {
  int length = 0;
  int time = 0;
  int angle = 0;
  int field = 0;
  bool operator==(const Dimension&) const = default;
};

struct Unit {
  double factor = 1.0;
  Dimension dimension;
};

struct NamedUnit {
  const char* name;
  Unit unit;
};

constexpr Dimension kNone{};
constexpr Dimension kLength{2, 0, 0, 0};
constexpr Dimension kTime{0, 2, 0, 0};
constexpr Dimension kPerTime{0, -2, 0, 0};
constexpr Dimension kSpeed{2, -2, 0, 0};
constexpr Dimension kAcceleration{2, -4, 0, 0};
constexpr Dimension kAngle{0, 0, 2, 0};
constexpr Dimension kField{0, 0, 0, 2};

constexpr std::array kUnits = {
    NamedUnit{"1", {1.0, kNone}},
    NamedUnit{"%", {1e-2, kNone}},
    NamedUnit{"ppm", {1e-6, kNone}},
    NamedUnit{"s", {1.0, kTime}},
    NamedUnit{"ms", {1e-3, kTime}},
    NamedUnit{"us", {1e-6, kTime}},
    NamedUnit{"ns", {1e-9, kTime}},
    NamedUnit{"min", {60.0, kTime}},
    NamedUnit{"h", {kHour, kTime}},
    NamedUnit{"Hz", {1.0, kPerTime}},
    NamedUnit{"kHz", {1e3, kPerTime}},
    NamedUnit{"m", {1.0, kLength}},
    NamedUnit{"mm", {1e-3, kLength}},
    NamedUnit{"cm", {1e-2, kLength}},
    NamedUnit{"km", {1e3, kLength}},
    NamedUnit{"ft", {0.3048, kLength}},
    NamedUnit{"kn", {kKnot, kSpeed}},
    NamedUnit{"rad", {1.0, kAngle}},
    NamedUnit{"mrad", {1e-3, kAngle}},
    NamedUnit{"urad", {1e-6, kAngle}},
    NamedUnit{"deg", {kDegree, kAngle}},
    NamedUnit{"mdeg", {1e-3 * kDegree, kAngle}},
    NamedUnit{"arcmin", {kArcMinute, kAngle}},
    NamedUnit{"arcsec", {kArcMinute / 60.0, kAngle}},
    NamedUnit{"g", {kStandardGravity, kAcceleration}},
    NamedUnit{"mg", {kMilliG, kAcceleration}},
    NamedUnit{"ug", {kMicroG, kAcceleration}},
    NamedUnit{"Gal", {1e3 * kMilliGal, kAcceleration}},
    NamedUnit{"mGal", {kMilliGal, kAcceleration}},
    NamedUnit{"uT", {1.0, kField}},
    NamedUnit{"nT", {1e-3, kField}},
    NamedUnit{"mT", {1e3, kField}},
    NamedUnit{"G", {100.0, kField}},
    NamedUnit{"mG", {0.1, kField}},
};

struct QuantityText {
  Dimension dimension;
  const char* name;
  const char* si;
  const char* examples;
};

const QuantityText& Describe(Quantity quantity) {
  static constexpr std::array<QuantityText, 14> kTable = {{
      {kNone, "ratio", "1", "1, %, ppm"},
      {kTime, "time", "s", "s, ms, us, ns, min, h"},
      {kPerTime, "frequency", "Hz", "Hz, kHz"},
      {kLength, "length", "m", "m, mm, cm, km"},
      {kSpeed, "speed", "m/s", "m/s, cm/s, km/h, kn"},
      {kAcceleration, "acceleration", "m/s^2", "m/s^2, g, mg, ug, mGal"},
      {kAngle, "angle", "rad", "rad, mrad, deg, arcmin, arcsec"},
      {{0, -2, 2, 0}, "angular rate", "rad/s", "rad/s, deg/s, deg/h"},
      {{0, -1, 2, 0},
       "gyro noise density",
       "rad/sqrt(s)",
       "deg/sqrt(h), deg/s/sqrt(Hz), deg/h/sqrt(Hz), rad/sqrt(s)"},
      {{2, -3, 0, 0},
       "accelerometer noise density",
       "m/s/sqrt(s)",
       "ug/sqrt(Hz), m/s/sqrt(h), m/s^2/sqrt(Hz)"},
      {{0, -3, 2, 0},
       "gyro bias walk",
       "rad/s/sqrt(s)",
       "deg/h/sqrt(h), deg/s/sqrt(s), deg/s^2/sqrt(Hz), rad/s/sqrt(s)"},
      {{2, -5, 0, 0},
       "accelerometer bias walk",
       "m/s^2/sqrt(s)",
       "ug/sqrt(s), mg/sqrt(h), ug/s/sqrt(Hz), m/s^2/sqrt(s)"},
      {{0, 1, 0, 0}, "noise per rate", "sqrt(s)", "sqrt(s), 1/sqrt(Hz)"},
      {kField, "magnetic field", "uT", "uT, nT, mG, G"},
  }};
  return kTable[static_cast<std::size_t>(quantity)];
}

Unit Scaled(const Unit& unit, double half_exponent) {
  const auto times = [&](int exponent) {
    return static_cast<int>(std::lround(exponent * half_exponent));
  };
  return {std::pow(unit.factor, half_exponent),
          {times(unit.dimension.length), times(unit.dimension.time),
           times(unit.dimension.angle), times(unit.dimension.field)}};
}

struct Synonym {
  std::string_view written;
  std::string_view meant;
};

/// Whole words of data sheets and of the titles of columns.
constexpr std::array kSynonyms = {
    Synonym{"hr", "h"},          Synonym{"hour", "h"},
    Synonym{"hours", "h"},       Synonym{"sec", "s"},
    Synonym{"second", "s"},      Synonym{"seconds", "s"},
    Synonym{"msec", "ms"},       Synonym{"usec", "us"},
    Synonym{"degree", "deg"},    Synonym{"degrees", "deg"},
    Synonym{"radian", "rad"},    Synonym{"radians", "rad"},
    Synonym{"meter", "m"},       Synonym{"meters", "m"},
    Synonym{"metre", "m"},       Synonym{"metres", "m"},
    Synonym{"knot", "kn"},       Synonym{"knots", "kn"},
    Synonym{"gauss", "G"},       Synonym{"Gauss", "G"},
    Synonym{"mgauss", "mG"},     Synonym{"mGauss", "mG"},
    Synonym{"microtesla", "uT"},
};

std::optional<Unit> FindUnit(std::string_view name) {
  for (const Synonym& synonym : kSynonyms) {
    if (name == synonym.written) name = synonym.meant;
  }
  for (const NamedUnit& known : kUnits) {
    if (name == known.name) return known.unit;
  }
  return std::nullopt;
}

void ReplaceAll(std::string_view from, std::string_view to, std::string* text) {
  for (std::size_t at = 0; (at = text->find(from, at)) != text->npos;
       at += to.size()) {
    text->replace(at, from.size(), to);
  }
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// "sqrtHz", "sqrt Hz" and "sqrt-Hz" as "sqrt(Hz)".
void BracketRoots(std::string* text) {
  constexpr std::string_view kRoot = "sqrt";
  for (std::size_t at = 0; (at = text->find(kRoot, at)) != text->npos;) {
    at += kRoot.size();
    while (at < text->size() && ((*text)[at] == ' ' || (*text)[at] == '-')) {
      text->erase(at, 1);
    }
    if (at == text->size() || !IsLetter((*text)[at])) continue;
    std::size_t end = at;
    while (end < text->size() && IsLetter((*text)[end])) ++end;
    text->insert(end, ")").insert(at, "(");
  }
}

/// "m/s2" as "m/s^2".
void RaiseExponents(std::string* text) {
  for (std::size_t i = 1; i < text->size(); ++i) {
    const char digit = (*text)[i];
    if ((digit == '2' || digit == '3') && IsLetter((*text)[i - 1])) {
      text->insert(i++, "^");
    }
  }
}

/// In ASCII, without the brackets around a first factor, a root as sqrt().
std::string PlainUnit(std::string_view unit) {
  static constexpr std::array kWritten = {
      Synonym{"\u00b5", "u"},          Synonym{"\u03bc", "u"},
      Synonym{"\u00b0", "deg"},        Synonym{"\u00ba", "deg"},
      Synonym{"\u00b2", "^2"},         Synonym{"\u00b3", "^3"},
      Synonym{"\u221a", "sqrt"},       Synonym{"\u00b7", "*"},
      Synonym{"/root", "/sqrt"},       Synonym{"/rt", "/sqrt"},
      Synonym{"Hz^(1/2)", "sqrt(Hz)"}, Synonym{"Hz^0.5", "sqrt(Hz)"},
      Synonym{"h^0.5", "sqrt(h)"},     Synonym{"h^(1/2)", "sqrt(h)"},
      Synonym{"mdps", "mdeg/s"},       Synonym{"dps", "deg/s"},
      Synonym{" per ", "/"},
  };
  std::string text(Trim(unit));
  for (const Synonym& synonym : kWritten) {
    ReplaceAll(synonym.written, synonym.meant, &text);
  }
  BracketRoots(&text);
  RaiseExponents(&text);
  if (const std::size_t close = text.find(')');
      text.starts_with('(') && close != text.npos) {
    text = text.substr(1, close - 1) + text.substr(close + 1);
  }
  return text;
}

std::optional<Unit> ParseFactor(std::string_view text) {
  text = Trim(text);
  if (text.starts_with("sqrt(") && text.ends_with(")")) {
    const auto inside = FindUnit(Trim(text.substr(5, text.size() - 6)));
    if (!inside) return std::nullopt;
    return Scaled(*inside, 0.5);
  }
  double exponent = 1.0;
  if (const std::size_t caret = text.find('^'); caret != text.npos) {
    const std::string_view digits = text.substr(caret + 1);
    if (digits != "2" && digits != "3") return std::nullopt;
    exponent = digits == "2" ? 2.0 : 3.0;
    text = text.substr(0, caret);
  }
  const auto unit = FindUnit(text);
  if (!unit) return std::nullopt;
  return Scaled(*unit, exponent);
}

std::optional<Unit> ParseUnit(std::string_view text) {
  Unit product;
  double sign = 1.0;
  while (true) {
    const std::size_t end = std::min(text.find_first_of("/*"), text.size());
    const auto factor = ParseFactor(text.substr(0, end));
    if (!factor) return std::nullopt;
    const Unit signed_factor = Scaled(*factor, sign);
    product.factor *= signed_factor.factor;
    product.dimension.length += signed_factor.dimension.length;
    product.dimension.time += signed_factor.dimension.time;
    product.dimension.angle += signed_factor.dimension.angle;
    product.dimension.field += signed_factor.dimension.field;
    if (end == text.size()) return product;
    sign = text[end] == '/' ? -1.0 : 1.0;
    text.remove_prefix(end + 1);
  }
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

double Convert(std::string_view text, std::string_view number,
               std::string_view unit, Quantity quantity) {
  const auto value = ParseNumber(number);
  if (!value) Fail(text, "does not start with a finite number", quantity);
  if (unit.empty()) Fail(text, "has no unit", quantity);
  const auto factor = UnitFactor(unit, quantity);
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
  const auto parsed = ParseUnit(PlainUnit(unit));
  if (!parsed || parsed->dimension != Describe(quantity).dimension) {
    return std::nullopt;
  }
  return parsed->factor;
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
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto result =
      fast_float::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() ||
      !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace hindsight
