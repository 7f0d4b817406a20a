#include "io/read/text_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "io/read/date_text.h"
#include "io/read/text_format.h"
#include "io/read/text_tokens.h"
#include "io/read/time_scale.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// UTC seconds since 1970.
double UnixFromGps(const Stamp& gps) {
  const double seconds = gps.Since({}) + static_cast<double>(kGpsEpochUnix);
  const auto whole = static_cast<std::int64_t>(std::floor(seconds));
  return seconds - LeapSeconds(whole - LeapSeconds(whole));
}

/// A date with its time of day, or a date alone, read in this order.
std::optional<Word> ParseDateWord(std::string_view token, DateOrder order) {
  using enum FileColumn::Holds;
  const auto seconds = [](const Stamp& as_written) {
    return as_written.Since({}) + static_cast<double>(kGpsEpochUnix);
  };
  if (const auto stamp = ParseIsoTime(token, false, order)) {
    return Word{kDates, seconds(*stamp), false, order};
  }
  if (const auto stamp = ParseIsoTime(token, true, order)) {
    return Word{kDates, UnixFromGps(*stamp), true, order};
  }
  if (const auto stamp = ParseDate(token, "00:00:00", false, order)) {
    return Word{kDays, seconds(*stamp), false, order};
  }
  return std::nullopt;
}

/// In both orders of 07/08/2025.
std::optional<Word> ParseDateOfAnyOrder(std::string_view token) {
  if (auto word = ParseDateWord(token, DateOrder::kYearFirst)) return word;
  const auto by_month = ParseDateWord(token, DateOrder::kMonthFirst);
  auto word = ParseDateWord(token, DateOrder::kDayFirst);
  if (!word && !by_month) return std::nullopt;
  if (!word) {
    word = by_month;
    word->order = DateOrder::kDayFirst;
    word->value = std::numeric_limits<double>::quiet_NaN();
  }
  if (by_month) word->month_first = by_month->value;
  return word;
}

/// A date with its time of day, or one of the two.
std::optional<Word> ParseTimeWord(std::string_view token) {
  using enum FileColumn::Holds;
  constexpr std::size_t kShortest = 7;
  const std::size_t sign = token.find_first_of("-/:.");
  if (token.size() < kShortest || sign == token.npos || sign == 0) {
    return std::nullopt;
  }
  if (const auto word = ParseDateOfAnyOrder(token)) return word;
  const std::string on_first_day = "1970-01-01T" + std::string(token);
  if (const auto stamp = ParseIsoTime(on_first_day, false)) {
    return Word{kTimesOfDay,
                stamp->Since({}) + static_cast<double>(kGpsEpochUnix), false};
  }
  if (const auto stamp = ParseIsoTime(on_first_day, true)) {
    return Word{kTimesOfDay, UnixFromGps(*stamp), true};
  }
  return std::nullopt;
}

Word ParseWord(std::string_view token) {
  using enum FileColumn::Holds;
  if (IsAbsentWord(token)) return {};
  if (const auto number = ParseNumber(token)) return {kNumbers, *number};
  if (const auto time = ParseTimeWord(token)) return *time;
  if (const auto place = ParsePlace(token)) {
    Word word{kNumbers, *place};
    word.side = static_cast<char>(token.back() & ~0x20);
    return word;
  }
  Word text{kText};
  if (token.size() == 1 &&
      std::string_view("NESW").find(token[0]) != std::string_view::npos) {
    text.side = token[0];
  }
  return text;
}

/// Whether more than half of what stands in a column is text.
std::vector<bool> TextColumnsOf(const std::vector<std::vector<Word>>& rows) {
  std::vector<bool> is_text(rows.front().size());
  for (std::size_t i = 0; i < is_text.size(); ++i) {
    std::size_t texts = 0;
    std::size_t others = 0;
    for (const std::vector<Word>& row : rows) {
      if (row[i].IsText()) {
        ++texts;
      } else if (row[i].holds) {
        ++others;
      }
    }
    is_text[i] = texts > others;
  }
  return is_text;
}

}  // namespace

bool ParseRow(std::string_view line, char delimiter, std::vector<Word>* words) {
  constexpr std::size_t kFewestBesideText = 3;
  words->clear();
  std::string pointed;
  if (GuessDecimal(line, delimiter) == ',') {
    pointed = line;
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    line = pointed;
  }
  std::size_t texts = 0;
  std::size_t numbers = 0;
  for (const std::string_view token : SplitLine(line, delimiter)) {
    words->push_back(ParseWord(token));
    if (words->back().IsText()) {
      ++texts;
    } else if (words->back().holds) {
      ++numbers;
    }
  }
  return texts == 0 ? numbers > 0
                    : numbers >= kFewestBesideText && numbers > texts;
}

std::optional<Shape> FindShape(const std::vector<std::string>& lines) {
  std::map<std::pair<char, std::size_t>, std::vector<std::vector<Word>>> alike;
  std::vector<Word> words;
  for (const std::string& line : lines) {
    if (IsComment(line)) continue;
    const char delimiter = GuessDelimiter(line);
    if (ParseRow(line, delimiter, &words)) {
      alike[{delimiter, words.size()}].push_back(words);
    }
    // Of tabs with nothing in between a run of blanks makes one.
    if (delimiter == ' ' && line.find('\t') != line.npos &&
        ParseRow(line, '\t', &words)) {
      alike[{'\t', words.size()}].push_back(words);
    }
  }
  std::optional<Shape> shape;
  std::size_t most = kFewestRows - 1;
  for (const auto& [form, rows] : alike) {
    const bool instead = shape && shape->delimiter == '\t' && form.first == ' ';
    if (rows.size() < most + (instead ? 0 : 1)) continue;
    most = rows.size();
    shape = Shape{form.first, TextColumnsOf(rows)};
  }
  return shape;
}

}  // namespace hindsight
