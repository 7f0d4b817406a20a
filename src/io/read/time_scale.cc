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

std::int64_t UnixSeconds(int year, unsigned month, unsigned day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(month),
                                         std::chrono::day(day)};
  return sys_days(date).time_since_epoch().count() * kDaySeconds;
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
  double value = 0.0;
  if (!ReadNumber(text, &value)) return std::nullopt;
  const double ticks = static_cast<double>(ticks_per_second);
  if (!IsTime(value / ticks)) return std::nullopt;
  // Below this size a double holds the stamp to better than 1e-8 of a tick.
  constexpr std::size_t kShort = 9;
  const bool is_whole = digits == text.size();
  if (digits <= kShort || !(is_whole || text[digits] == '.') ||
      text.find_first_of("eE") != text.npos) {
    return Stamp{0, value / ticks};
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
