#include "io/read/title_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "io/read/units.h"

namespace hindsight {
namespace {

bool IsUpper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool IsAlpha(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool IsLowerAt(const std::string& name, std::size_t i) {
  return i < name.size() && IsAlpha(name[i]) && !IsUpper(name[i]);
}
char Lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

struct UnitWord {
  std::string_view word;
  std::string_view unit;
};

/// The end of a title, where a unit stands without brackets.
std::string UnitOfWord(const std::string& word) {
  static constexpr std::array kUnits = {
      UnitWord{"radps", "rad/s"}, UnitWord{"rads", "rad/s"},
      UnitWord{"dps", "deg/s"},   UnitWord{"degps", "deg/s"},
      UnitWord{"mps", "m/s"},     UnitWord{"kmh", "km/h"},
      UnitWord{"kph", "km/h"},    UnitWord{"kts", "kn"},
      UnitWord{"knots", "kn"},    UnitWord{"mm", "mm"},
      UnitWord{"cm", "cm"},       UnitWord{"deg", "deg"},
      UnitWord{"rad", "rad"},     UnitWord{"sec", "s"},
      UnitWord{"s", "s"},         UnitWord{"ms", "ms"},
      UnitWord{"us", "us"},       UnitWord{"ns", "ns"},
      UnitWord{"m", "m"},         UnitWord{"ut", "uT"},
      UnitWord{"mg", "mg"},       UnitWord{"degrees", "deg"},
      UnitWord{"seconds", "s"},   UnitWord{"millis", "ms"},
      UnitWord{"micros", "us"},   UnitWord{"nanos", "ns"},
      UnitWord{"meters", "m"},    UnitWord{"metres", "m"},
      UnitWord{"ft", "ft"},       UnitWord{"feet", "ft"},
      UnitWord{"mph", "mph"}};
  for (const UnitWord& known : kUnits) {
    if (word == known.word) return std::string(known.unit);
  }
  return "";
}

}  // namespace

std::vector<std::string> SplitWords(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!IsAlpha(c) && !digit) {
      end();
      continue;
    }
    if (!word.empty()) {
      const bool was_alpha = IsAlpha(word.back());
      const bool hump =
          i > 0 && IsUpper(c) && IsAlpha(name[i - 1]) &&
          (!IsUpper(name[i - 1]) ||
           (i > 1 && IsLowerAt(name, i + 1) && IsLowerAt(name, i + 2)));
      if (hump || was_alpha == digit) end();
    }
    word += Lower(c);
  }
  end();
  return words;
}

bool HasAnyWord(const std::vector<std::string>& words,
                std::initializer_list<std::string_view> names) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(names.begin(), names.end(), word) != names.end();
  });
}

std::string TakeBracketedUnit(std::string* title) {
  const std::size_t last = title->find_last_not_of(" \t\"");
  if (last == title->npos) return "";
  const bool ends = (*title)[last] == ']' || (*title)[last] == ')';
  // "Gyroscope (x) [rad/s]" ends with its unit, "Time (s) since start" does not.
  const bool square =
      ends ? (*title)[last] == ']' : title->find('[') < title->find('(');
  const char mark = square ? '[' : '(';
  std::size_t open = title->find(mark);
  if (ends && square) open = title->rfind(mark);
  const std::size_t close = title->rfind(square ? ']' : ')');
  if (open == title->npos || close == title->npos || close < open) return "";
  const std::string unit(
      Trim(std::string_view(*title).substr(open + 1, close - open - 1)));
  const bool axis = unit.size() == 1 && unit >= "x" && unit <= "z";
  // "IMU(0):accel:X" counts what it names, "Accelerometer (x)" names its axis.
  if (axis || (!ends && unit.find_first_not_of("0123456789") == unit.npos)) {
    return "";
  }
  title->erase(open);
  return unit;
}

std::string TakeUnitWord(std::vector<std::string>* words) {
  if (words->size() < 2) return "";
  if (words->size() > 2 && words->back() == "2" &&
      (*words)[words->size() - 2] == "mps") {
    words->resize(words->size() - 2);
    return "m/s^2";
  }
  // "GyroXRadPerSec".
  const std::size_t count = words->size();
  if (count > 3 && (*words)[count - 2] == "per" &&
      HasAnyWord({words->back()}, {"s", "sec", "second"})) {
    const std::string unit = UnitOfWord((*words)[count - 3]);
    if (!unit.empty()) {
      words->resize(count - 3);
      return unit + "/s";
    }
  }
  // "vel_n_cm_s".
  if (words->size() > 2 && words->back() == "s") {
    const std::string length = (*words)[words->size() - 2];
    for (const char* known : {"m", "cm", "mm"}) {
      if (length != known) continue;
      words->resize(words->size() - 2);
      return length + "/s";
    }
  }
  const std::string unit = UnitOfWord(words->back());
  if (!unit.empty()) words->pop_back();
  return unit;
}

}  // namespace hindsight
