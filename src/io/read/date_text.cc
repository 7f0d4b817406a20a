#include "io/read/date_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <string>
#include <utility>

#include "io/read/units.h"

namespace hindsight {
namespace {

/// Between them nanoseconds since 1980 fit 64 bits.
constexpr int kFirstYear = 1900;
constexpr int kLastYear = 2250;

std::optional<int> ParseInteger(std::string_view text) {
  int value = 0;
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || text[0] == '-' || result.ec != std::errc() ||
      result.ptr != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// Three numbers behind each other with one separator between them.
struct Triple {
  std::array<std::string_view, 3> words;
  char separator = '\0';
};

std::optional<Triple> SplitTriple(std::string_view text,
                                  std::string_view separators) {
  const std::size_t first = text.find_first_of(separators);
  if (first == text.npos) return std::nullopt;
  const std::size_t second = text.find(text[first], first + 1);
  if (second == text.npos) return std::nullopt;
  return Triple{
      {text.substr(0, first), text.substr(first + 1, second - first - 1),
       text.substr(second + 1)},
      text[first]};
}

/// Seconds since 1970.
std::optional<std::int64_t> DayOf(std::string_view year_word,
                                  std::string_view month_word,
                                  std::string_view day_word) {
  constexpr std::size_t kYearDigits = 4;
  constexpr std::size_t kMostDigits = 2;
  if (year_word.size() != kYearDigits || month_word.size() > kMostDigits ||
      day_word.size() > kMostDigits) {
    return std::nullopt;
  }
  const auto year = ParseInteger(year_word);
  const auto month = ParseInteger(month_word);
  const auto day = ParseInteger(day_word);
  if (!year || !month || !day || *year < kFirstYear || *year > kLastYear) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(unsigned(*month)),
                                         std::chrono::day(unsigned(*day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count() * kDaySeconds;
}

/// "6" of "Jun" and "June"; "" of another word.
std::string_view MonthNumber(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12>
      kMonths = {{{"january", "1"},
                  {"february", "2"},
                  {"march", "3"},
                  {"april", "4"},
                  {"may", "5"},
                  {"june", "6"},
                  {"july", "7"},
                  {"august", "8"},
                  {"september", "9"},
                  {"october", "10"},
                  {"november", "11"},
                  {"december", "12"}}};
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(c | 0x20);
  for (const auto& [month, number] : kMonths) {
    if (lower == month || lower == month.substr(0, 3)) return number;
  }
  return "";
}

std::optional<std::int64_t> ParseDay(std::string_view date, DateOrder order) {
  const auto triple = SplitTriple(date, "-/.");
  if (!triple) return std::nullopt;
  const auto& [a, b, c] = triple->words;
  if (triple->separator == '.') return DayOf(c, b, a);
  if (const auto month = MonthNumber(b); !month.empty()) {
    return DayOf(c, month, a);
  }
  if (const auto day = DayOf(a, b, c)) return day;
  if (order == DateOrder::kDayFirst) return DayOf(c, b, a);
  if (order == DateOrder::kMonthFirst) return DayOf(c, a, b);
  return std::nullopt;
}

/// East of Greenwich [s], of "Z", "+02:00", "-0330" or "+02".
std::optional<std::int64_t> ParseZone(std::string_view zone) {
  if (zone == "Z") return 0;
  const bool is_colon = zone.size() == 6 && zone[3] == ':';
  if (zone.size() != 3 && zone.size() != 5 && !is_colon) return std::nullopt;
  const auto hours = ParseInteger(zone.substr(1, 2));
  const auto minutes = zone.size() == 3
                           ? std::optional<int>(0)
                           : ParseInteger(zone.substr(zone.size() - 2));
  if (!hours || !minutes || *hours > 14 || *minutes > 59) return std::nullopt;
  const std::int64_t seconds = *hours * 3600 + *minutes * 60;
  return zone[0] == '-' ? -seconds : seconds;
}

/// Takes " AM" or " PM" off the end: 'A', 'P', or '\0'.
char TakeHalfOfDay(std::string_view* clock) {
  constexpr std::size_t kMark = 2;
  if (clock->size() <= kMark) return '\0';
  const char half = static_cast<char>((*clock)[clock->size() - kMark] & ~0x20);
  const char mark = static_cast<char>(clock->back() & ~0x20);
  if (mark != 'M' || (half != 'A' && half != 'P')) return '\0';
  clock->remove_suffix(kMark);
  *clock = Trim(*clock);
  return half;
}

std::optional<Stamp> ParseClock(std::string_view clock) {
  constexpr int kNoon = 12;
  const char half = TakeHalfOfDay(&clock);
  const auto triple = SplitTriple(clock, ":");
  if (!triple) return std::nullopt;
  const auto& [hours, minutes, seconds] = triple->words;
  const std::size_t point = std::min(seconds.find('.'), seconds.size());
  if (hours.size() > 2 || minutes.size() != 2 || point != 2) {
    return std::nullopt;
  }
  auto hour = ParseInteger(hours);
  const auto minute = ParseInteger(minutes);
  const auto second = ParseInteger(seconds.substr(0, point));
  if (!hour || !minute || !second || *hour > 23 || *minute > 59 ||
      *second > 60) {
    return std::nullopt;
  }
  if (half != '\0') {
    if (*hour < 1 || *hour > kNoon) return std::nullopt;
    *hour = *hour % kNoon + (half == 'P' ? kNoon : 0);
  }
  double fraction = 0.0;
  if (point < seconds.size()) {
    const auto digits = ParseNumber(seconds.substr(point));
    if (!digits) return std::nullopt;
    fraction = *digits;
  }
  return Stamp{*hour * 3600 + *minute * 60 + *second, fraction};
}

}  // namespace

std::optional<Stamp> ParseDate(std::string_view date, std::string_view clock,
                               bool utc, DateOrder order) {
  const auto day = ParseDay(date, order);
  const auto time = ParseClock(clock);
  if (!day || !time) return std::nullopt;
  // At 23:59:60 the leap second itself is not counted yet.
  const int leap = utc ? LeapSeconds(*day) : 0;
  return Stamp{*day + time->seconds - kGpsEpochUnix + leap, time->fraction};
}

std::optional<Stamp> ParseTimeOfDay(std::string_view clock) {
  std::string colons(clock);
  if (clock.find(':') == clock.npos && clock.size() >= 6) {
    colons.insert(4, ":").insert(2, ":");
  }
  return ParseClock(colons);
}

std::optional<Stamp> ParseIsoTime(std::string_view text, bool utc,
                                  DateOrder order) {
  text = Trim(text);
  const std::size_t gap = text.find_first_of("T ");
  if (gap == text.npos) return std::nullopt;
  const std::string_view date = text.substr(0, gap);
  std::string_view clock = Trim(text.substr(gap + 1));
  const std::size_t zone_at = clock.find_first_of("Z+-");
  std::int64_t offset = 0;
  if (zone_at != clock.npos) {
    const auto zone = ParseZone(clock.substr(zone_at));
    if (!utc || !zone) return std::nullopt;
    offset = *zone;
    clock = clock.substr(0, zone_at);
  }
  const auto day = ParseDay(date, order);
  const auto time = ParseClock(clock);
  if (!day || !time) return std::nullopt;
  const std::int64_t unix_time = *day + time->seconds - offset;
  // At 23:59:60 the leap second itself is not counted yet.
  const bool is_leap = clock.find(":60") != clock.npos;
  const int leap = utc ? LeapSeconds(unix_time - (is_leap ? 1 : 0)) : 0;
  return Stamp{unix_time - kGpsEpochUnix + leap, time->fraction};
}

std::optional<Stamp> ParseDateTime(std::string_view text) {
  text = Trim(text);
  bool utc = false;
  if (text.ends_with("UTC")) {
    utc = true;
    text.remove_suffix(3);
  } else if (text.ends_with("GPST")) {
    text.remove_suffix(4);
  } else {
    return std::nullopt;
  }
  text = Trim(text);
  const std::size_t gap = text.find(' ');
  if (gap == text.npos) return std::nullopt;
  return ParseDate(text.substr(0, gap), Trim(text.substr(gap)), utc);
}

}  // namespace hindsight
