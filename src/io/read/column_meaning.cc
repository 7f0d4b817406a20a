#include "io/read/column_meaning.h"

#include <array>
#include <string_view>
#include <utility>

#include "io/read/file_formats.h"
#include "io/read/title_words.h"
#include "io/read/unit_grammar.h"
#include "io/read/units.h"
#include "io/read/word_meaning.h"

namespace hindsight {
namespace {

/// The column of an array in its reference: 2 of "imu_gyr:2"; 0 of one alone.
int ArrayColumn(const std::string& reference) {
  const std::size_t colon = reference.rfind(':');
  return colon == reference.npos ? 0 : std::stoi(reference.substr(colon + 1));
}

ColumnMeaning MeaningInArray(const FileColumn& column) {
  const int number = ArrayColumn(column.reference);
  const std::string array = column.title.substr(column.title.rfind('/') + 1);
  if (IsOfTime(SplitWords(array))) {
    return number == 0 ? ColumnMeaning{"t", ""} : ColumnMeaning{};
  }
  Words words = SplitWords(column.title);
  if (number >= 1 && number <= 4) {
    static constexpr std::array kAxes = {"x", "y", "z"};
    static constexpr std::array kParts = {"w", "x", "y", "z"};
    const bool quaternion = HasAnyWord(
        words, {"quat", "quaternion", "orientation", "orientations"});
    if (quaternion) {
      return {std::string("q_") + kParts[static_cast<std::size_t>(number - 1)],
              ""};
    }
    if (number <= 3) {
      words.emplace_back(kAxes[static_cast<std::size_t>(number - 1)]);
    }
  }
  return MeaningOfWords(words);
}

}  // namespace

ColumnMeaning MeaningOfTitle(const std::string& title) {
  std::string text = title;
  std::string unit = TakeBracketedUnit(&text);
  Words words = SplitWords(text);
  constexpr std::string_view kIndices = "012";
  if (unit.size() == 1 && kIndices.find(unit[0]) != kIndices.npos) {
    words.emplace_back(1, static_cast<char>('x' + (unit[0] - '0')));
    return InertialMeaning(words);
  }
  // "Alt [ft MSL]"
  if (const std::size_t blank = unit.find(' ');
      blank != unit.npos && !MeaningOfUnit(unit) &&
      MeaningOfUnit(unit.substr(0, blank))) {
    for (std::string& word : SplitWords(unit.substr(blank))) {
      words.push_back(std::move(word));
    }
    unit.resize(blank);
  }
  if (unit.empty()) unit = TakeUnitWord(&words);
  ColumnMeaning meaning = MeaningOfWords(words);
  meaning.unit = unit;
  // "Week [s]" is its seconds.
  if (meaning.quantity == "week" && UnitFactor(unit, Quantity::kTime)) {
    meaning.quantity = "t";
  }
  if (meaning.quantity == "speed" && HasAnyWord(words, {"wheel"}) &&
      UnitFactor(unit, Quantity::kAngularRate)) {
    meaning.quantity = "wheel_rate";
  }
  // "Gx [g]" is a force.
  if (meaning.quantity.starts_with("gyro_") &&
      UnitFactor(unit, Quantity::kAcceleration)) {
    meaning.quantity.replace(0, 4, "accel");
  }
  return UnitFactor(unit, Quantity::kSpeed) ? AsVelocity(std::move(meaning))
                                            : meaning;
}

ColumnMeaning AsVelocity(ColumnMeaning meaning) {
  for (const auto& [place, velocity] :
       {std::pair("p_x", "v_n"), {"p_y", "v_e"}, {"p_z", "v_d"}}) {
    if (meaning.quantity == place) {
      meaning.quantity = velocity;
      break;
    }
  }
  return meaning;
}

ColumnMeaning AxisMeaning(const std::string& title, const std::string& family) {
  std::string text = title;
  const std::string unit = TakeBracketedUnit(&text);
  const Words words = SplitWords(text);
  const bool alone =
      words.size() == 1 || (words.size() == 2 && words[1] == "axis");
  const bool axis =
      alone && words[0].size() == 1 && words[0] >= "x" && words[0] <= "z";
  return axis ? ColumnMeaning{family + words[0], unit} : ColumnMeaning{};
}

ColumnMeaning MeaningOfColumn(const FileColumn& column,
                              const FileFormat& format) {
  if (column.holds == FileColumn::Holds::kText) return {};
  return &format == &ColumnsFormat() ? MeaningOfTitle(column.title)
                                     : MeaningInArray(column);
}

}  // namespace hindsight
