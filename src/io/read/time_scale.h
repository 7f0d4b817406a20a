#ifndef HINDSIGHT_IO_READ_TIME_SCALE_H_
#define HINDSIGHT_IO_READ_TIME_SCALE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hindsight {

/// A stamp as a file gives it, without loss for stamps of any age: `seconds`
/// whole seconds and a `fraction` of any size on top.
struct Stamp {
  std::int64_t seconds = 0;
  double fraction = 0.0;

  /// this - other [s].
  double Since(const Stamp& other) const {
    return static_cast<double>(seconds - other.seconds) +
           (fraction - other.fraction);
  }
  Stamp Later(double dt) const { return {seconds, fraction + dt}; }
};

inline constexpr std::int64_t kDaySeconds = 86400;
/// Seconds of a GPS week.
inline constexpr std::int64_t kWeekSeconds = 7 * kDaySeconds;
/// 1980-01-06 0 h UTC, where GPS time begins, in seconds since 1970.
inline constexpr std::int64_t kGpsEpochUnix = 315964800;

/// Stamps beyond this are no times [s]: its nanoseconds fit 64 bits.
inline constexpr double kLongestTime = 9e9;
/// As a GPS week.
inline constexpr int kLastWeek = 14000;
bool IsTime(double seconds);

/// Reads "1720467261.854" in units of 1/`ticks_per_second` (1, 1000, 1e6, 1e9);
/// nanoseconds since 1970 are not rounded. Nothing if `text` is no finite
/// number, or is beyond kLongestTime.
std::optional<Stamp> ParseStamp(std::string_view text,
                                std::int64_t ticks_per_second);

/// GPS minus UTC [s] at a UTC instant, seconds since 1970 without leap seconds.
int LeapSeconds(std::int64_t unix_seconds);

/// GPS time since 1980-01-06 of UTC seconds since 1970.
Stamp GpsFromUnix(const Stamp& unix_time);

/// GPS time since 1980-01-06 of a UTC time of day [s], 86400 and more within a
/// leap second, on a day counted from 1970.
Stamp GpsFromUtc(std::int64_t day, double time_of_day);

/// "yyyy-mm-dd hh:mm:ss.sssssssss GPST".
std::string FormatGpsTime(std::int64_t gps_ns);

/// "yyyy-mm-ddThh:mm:ss.sssZ", UTC.
std::string FormatUtcTime(std::int64_t gps_ns);

/// An instant as GPS receivers count it.
struct GpsWeekTime {
  std::int64_t week = 0;
  double seconds = 0.0;  ///< [0, kWeekSeconds)
};
GpsWeekTime GpsWeekOf(std::int64_t gps_ns);

/// What the header of a result says of t = 0: "# epoch: t = 0 is GPS week 2374
/// second 243261.854000000, 2025-07-08T19:34:03.854Z\n", or that the clock has
/// no date.
std::string EpochComment(std::optional<std::int64_t> epoch_gps_ns);

std::int64_t Nanoseconds(const Stamp& stamp);
Stamp StampFromNanoseconds(std::int64_t ns);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TIME_SCALE_H_
