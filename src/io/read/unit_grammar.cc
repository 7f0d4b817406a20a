#include "io/read/unit_grammar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/units.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Dimension = UnitMeaning::Dimension;

struct NamedUnit {
  const char* name;
  UnitMeaning unit;
};

constexpr double kMilePerHour = 1609.344 / 3600.0;  // m/s

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
    NamedUnit{"um", {1e-6, kLength}},
    NamedUnit{"cm", {1e-2, kLength}},
    NamedUnit{"km", {1e3, kLength}},
    NamedUnit{"ft", {0.3048, kLength}},
    NamedUnit{"kn", {kKnot, kSpeed}},
    NamedUnit{"mph", {kMilePerHour, kSpeed}},
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

UnitMeaning Scaled(const UnitMeaning& unit, double half_exponent) {
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
    Synonym{"hr", "h"},       Synonym{"hour", "h"},
    Synonym{"hours", "h"},    Synonym{"sec", "s"},
    Synonym{"second", "s"},   Synonym{"seconds", "s"},
    Synonym{"msec", "ms"},    Synonym{"usec", "us"},
    Synonym{"degree", "deg"}, Synonym{"degrees", "deg"},
    Synonym{"radian", "rad"}, Synonym{"radians", "rad"},
    Synonym{"meter", "m"},    Synonym{"meters", "m"},
    Synonym{"metre", "m"},    Synonym{"metres", "m"},
    Synonym{"knot", "kn"},    Synonym{"knots", "kn"},
    Synonym{"gauss", "G"},    Synonym{"Gauss", "G"},
    Synonym{"mgauss", "mG"},  Synonym{"mGauss", "mG"},
    Synonym{"gn", "g"},
};

std::optional<UnitMeaning> FindUnit(std::string_view name) {
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
      Synonym{"\u00b5", "u"},
      Synonym{"\u03bc", "u"},
      Synonym{"\u00b0", "deg"},
      Synonym{"\u00ba", "deg"},
      Synonym{"\u00b2", "^2"},
      Synonym{"\u00b3", "^3"},
      Synonym{"\u221a", "sqrt"},
      Synonym{"\u00b7", "*"},
      Synonym{"\u00bd", "^0.5"},
      Synonym{"\u2044", "/"},
      Synonym{"\u2215", "/"},
      Synonym{"\u2099", "n"},
      Synonym{" rms", ""},
      Synonym{" RMS", ""},
      Synonym{"HZ", "Hz"},
      Synonym{"microtesla", "uT"},
      Synonym{"micro-", "u"},
      Synonym{"microg", "ug"},
      Synonym{"milli-", "m"},
      Synonym{"millig", "mg"},
      Synonym{" Hz^-0.5", "/sqrt(Hz)"},
      Synonym{" Hz^-1/2", "/sqrt(Hz)"},
      Synonym{"DPS", "deg/s"},
      Synonym{"/root", "/sqrt"},
      Synonym{"/rt", "/sqrt"},
      Synonym{"Hz^(1/2)", "sqrt(Hz)"},
      Synonym{"Hz^0.5", "sqrt(Hz)"},
      Synonym{"h^0.5", "sqrt(h)"},
      Synonym{"h^(1/2)", "sqrt(h)"},
      Synonym{"mdps", "mdeg/s"},
      Synonym{"dps", "deg/s"},
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

std::optional<UnitMeaning> ParseFactor(std::string_view text) {
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

}  // namespace

std::optional<UnitMeaning> MeaningOfUnit(std::string_view unit) {
  const std::string plain = PlainUnit(unit);
  std::string_view text = plain;
  UnitMeaning product;
  double sign = 1.0;
  while (true) {
    const std::size_t end = std::min(text.find_first_of("/*"), text.size());
    const auto factor = ParseFactor(text.substr(0, end));
    if (!factor) return std::nullopt;
    const UnitMeaning signed_factor = Scaled(*factor, sign);
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

}  // namespace hindsight
