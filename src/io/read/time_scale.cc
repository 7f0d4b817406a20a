#include "io/read/time_scale.h"

#include <fmt/chrono.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include "io/read/units.h"

namespace hindsight {
namespace {

using std::chrono::sys_days;

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// Between them nanoseconds since 1980 fit 64 bits.
constexpr int kFirstYear = 1900;
constexpr int kLastYear = 2250;

std::int64_t UnixSeconds(int year, unsigned month, unsigned day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(month),
                                         std::chrono::day(day)};
  return sys_days(date).time_since_epoch().count() * kDaySeconds;
}

std::optional<int> ParseInteger(std::string_view text) {
  int value = 0;
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> ParseDay(std::string_view date) {
  if (date.size() != 10 || (date[4] != '-' && date[4] != '/') ||
      date[7] != date[4]) {
    return std::nullopt;
  }
  const auto year = ParseInteger(date.substr(0, 4));
  const auto month = ParseInteger(date.substr(5, 2));
  const auto day = ParseInteger(date.substr(8, 2));
  if (!year || !month || !day || *month < 1 || *day < 1) return std::nullopt;
  if (*year < kFirstYear || *year > kLastYear) return std::nullopt;
  const std::chrono::year_month_day checked{
      std::chrono::year(*year), std::chrono::month(unsigned(*month)),
      std::chrono::day(unsigned(*day))};
  if (!checked.ok()) return std::nullopt;
  return UnixSeconds(*year, unsigned(*month), unsigned(*day));
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
  if (!hours || !minutes || *hours < 0 || *hours > 14 || *minutes < 0 ||
      *minutes > 59) {
    return std::nullopt;
  }
  const std::int64_t seconds = *hours * 3600 + *minutes * 60;
  return zone[0] == '-' ? -seconds : seconds;
}

std::optional<Stamp> ParseClock(std::string_view clock) {
  if (clock.size() < 8 || clock[2] != ':' || clock[5] != ':') {
    return std::nullopt;
  }
  const auto hour = ParseInteger(clock.substr(0, 2));
  const auto minute = ParseInteger(clock.substr(3, 2));
  const auto second = ParseInteger(clock.substr(6, 2));
  if (!hour || !minute || !second || *hour < 0 || *hour > 23 || *minute < 0 ||
      *minute > 59 || *second < 0 || *second > 60) {
    return std::nullopt;
  }
  double fraction = 0.0;
  if (clock.size() > 8) {
    if (clock[8] != '.') return std::nullopt;
    const auto digits = ParseNumber(clock.substr(8));
    if (!digits) return std::nullopt;
    fraction = *digits;
  }
  return Stamp{*hour * 3600 + *minute * 60 + *second, fraction};
}

}  // namespace

bool IsTime(double seconds) { return std::abs(seconds) <= kLongestTime; }

std::optional<Stamp> ParseStamp(std::string_view text,
                                std::int64_t ticks_per_second) {
  // By hand: find_first_not_of looks each character up in the set by a call.
  std::size_t digits = 0;
  while (digits < text.size() && text[digits] >= '0' && text[digits] <= '9') {
    ++digits;
  }
  const auto value = ParseNumber(text);
  if (!value) return std::nullopt;
  const double ticks = static_cast<double>(ticks_per_second);
  if (!IsTime(*value / ticks)) return std::nullopt;
  // Below this size a double holds the stamp to better than 1e-8 of a tick.
  constexpr std::size_t kShort = 9;
  const bool is_whole = digits == text.size();
  if (digits <= kShort || !(is_whole || text[digits] == '.') ||
      text.find_first_of("eE") != text.npos) {
    return Stamp{0, *value / ticks};
  }
  std::int64_t count = 0;
  if (std::from_chars(text.data(), text.data() + digits, count).ec !=
      std::errc()) {
    return std::nullopt;
  }
  double part = 0.0;
  if (digits + 1 < text.size()) {
    part = ParseNumber(text.substr(digits)).value_or(0.0);
  }
  return Stamp{count / ticks_per_second,
               (static_cast<double>(count % ticks_per_second) + part) / ticks};
}

int LeapSeconds(std::int64_t unix_seconds) {
  static const std::array<std::int64_t, 18> kInserted = {
      UnixSeconds(1981, 7, 1), UnixSeconds(1982, 7, 1), UnixSeconds(1983, 7, 1),
      UnixSeconds(1985, 7, 1), UnixSeconds(1988, 1, 1), UnixSeconds(1990, 1, 1),
      UnixSeconds(1991, 1, 1), UnixSeconds(1992, 7, 1), UnixSeconds(1993, 7, 1),
      UnixSeconds(1994, 7, 1), UnixSeconds(1996, 1, 1), UnixSeconds(1997, 7, 1),
      UnixSeconds(1999, 1, 1), UnixSeconds(2006, 1, 1), UnixSeconds(2009, 1, 1),
      UnixSeconds(2012, 7, 1), UnixSeconds(2015, 7, 1), UnixSeconds(2017, 1, 1),
  };
  int count = 0;
  while (count < static_cast<int>(kInserted.size()) &&
         unix_seconds >= kInserted[static_cast<std::size_t>(count)]) {
    ++count;
  }
  return count;
}

Stamp GpsFromUnix(const Stamp& unix_time) {
  const double whole = std::floor(unix_time.fraction);
  const std::int64_t seconds =
      unix_time.seconds + static_cast<std::int64_t>(whole);
  return {seconds - kGpsEpochUnix + LeapSeconds(seconds),
          unix_time.fraction - whole};
}

Stamp GpsFromUtc(std::int64_t day, double time_of_day) {
  const std::int64_t midnight = day * kDaySeconds;
  return {midnight - kGpsEpochUnix + LeapSeconds(midnight), time_of_day};
}

std::optional<Stamp> ParseDate(std::string_view date, std::string_view clock,
                               bool utc) {
  const auto day = ParseDay(date);
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
  const auto time = ParseClock(colons);
  if (!time) return std::nullopt;
  return Stamp{time->seconds, time->fraction};
}

std::optional<Stamp> ParseIsoTime(std::string_view text, bool utc) {
  constexpr std::size_t kDate = 10;
  text = Trim(text);
  if (text.size() <= kDate || (text[kDate] != 'T' && text[kDate] != ' ')) {
    return std::nullopt;
  }
  const std::size_t zone_at = text.find_first_of("Z+-", kDate + 1);
  std::int64_t offset = 0;
  if (zone_at != text.npos) {
    const auto zone = ParseZone(text.substr(zone_at));
    if (!utc || !zone) return std::nullopt;
    offset = *zone;
  }
  const auto day = ParseDay(text.substr(0, kDate));
  const auto time = ParseClock(text.substr(
      kDate + 1, zone_at == text.npos ? zone_at : zone_at - kDate - 1));
  if (!day || !time) return std::nullopt;
  const std::int64_t unix_time = *day + time->seconds - offset;
  // At 23:59:60 the leap second itself is not counted yet.
  const bool is_leap = text.substr(kDate + 7, 2) == "60";
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
  if (text.size() < 12) return std::nullopt;
  return ParseDate(text.substr(0, 10), Trim(text.substr(10)), utc);
}

std::string FormatGpsTime(std::int64_t gps_ns) {
  const std::chrono::nanoseconds time(gps_ns);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:09} GPST",
                     fmt::gmtime(seconds.count() + kGpsEpochUnix),
                     (time - seconds).count());
}

std::string FormatUtcTime(std::int64_t gps_ns) {
  const auto time = std::chrono::floor<std::chrono::milliseconds>(
      std::chrono::nanoseconds(gps_ns) + std::chrono::microseconds(500));
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  const std::int64_t gps_unix = seconds.count() + kGpsEpochUnix;
  // The leap seconds are listed by UTC, which is what is sought.
  const std::int64_t unix_s =
      gps_unix - LeapSeconds(gps_unix - LeapSeconds(gps_unix));
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(unix_s),
                     (time - seconds).count());
}

GpsWeekTime GpsWeekOf(std::int64_t gps_ns) {
  const std::chrono::nanoseconds time(gps_ns);
  const auto week = std::chrono::floor<std::chrono::weeks>(time);
  return {week.count(), static_cast<double>((time - week).count()) / 1e9};
}

std::string EpochComment(std::optional<std::int64_t> epoch_gps_ns) {
  if (!epoch_gps_ns) return "# epoch: the recording's clock has no date\n";
  const GpsWeekTime time = GpsWeekOf(*epoch_gps_ns);
  return fmt::format("# epoch: t = 0 is GPS week {} second {:.9f}, {}\n",
                     time.week, time.seconds, FormatUtcTime(*epoch_gps_ns));
}

std::int64_t Nanoseconds(const Stamp& stamp) {
  return stamp.seconds * kNanosecondsPerSecond +
         std::llround(stamp.fraction * 1e9);
}

Stamp StampFromNanoseconds(std::int64_t ns) {
  return {ns / kNanosecondsPerSecond,
          static_cast<double>(ns % kNanosecondsPerSecond) * 1e-9};
}

}  // namespace hindsight
