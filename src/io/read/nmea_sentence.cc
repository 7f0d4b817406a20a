#include "io/read/nmea_sentence.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "base/units.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"

namespace hindsight {

std::vector<std::string_view> SplitNmea(std::string_view line) {
  line = Trim(line);
  if (!line.starts_with('$') && !line.starts_with('!')) {
    throw NmeaProblem{"is no NMEA sentence; expected '$' at its start"};
  }
  const std::size_t star = line.rfind('*');
  if (star == line.npos) {
    throw NmeaProblem{
        "the sentence has no checksum; expected '*' and two digits"};
  }
  unsigned sum = 0;
  for (const char c : line.substr(1, star - 1)) {
    sum ^= static_cast<unsigned char>(c);
  }
  unsigned stated = 0;
  const char* end = line.data() + line.size();
  const auto result = std::from_chars(line.data() + star + 1, end, stated, 16);
  if (result.ec != std::errc() || result.ptr != end ||
      line.size() != star + 3) {
    throw NmeaProblem{"the checksum is not two hexadecimal digits"};
  }
  if (stated != sum)
    throw NmeaProblem{"the checksum is wrong: a damaged sentence"};
  return SplitLine(line.substr(1, star - 1), ',');
}

double NmeaNumber(std::string_view text, const char* what) {
  const auto number = ParseNumber(text);
  if (!number) {
    throw NmeaProblem{std::string(what) + ": '" + std::string(text) +
                      "' is not a finite number"};
  }
  return *number;
}

double NmeaTimeOfDay(std::string_view text) {
  const double value = NmeaNumber(text, "the time");
  const double hours = std::floor(value / 1e4);
  const double minutes = std::floor((value - 1e4 * hours) / 1e2);
  const double seconds = value - 1e4 * hours - 1e2 * minutes;
  if (value < 0.0 || hours > 23.0 || minutes > 59.0 || seconds >= 61.0) {
    throw NmeaProblem{"'" + std::string(text) +
                      "' is not a time; expected hhmmss"};
  }
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

double NmeaAngle(std::string_view text, std::string_view hemisphere,
                 char positive, char negative, double largest_deg) {
  const double value = NmeaNumber(text, "an angle");
  const double degrees = std::floor(value / 100.0);
  const double minutes = value - 100.0 * degrees;
  const double angle = degrees + minutes / 60.0;
  const bool known = hemisphere.size() == 1 &&
                     (hemisphere[0] == positive || hemisphere[0] == negative);
  if (value < 0.0 || minutes >= 60.0 || angle > largest_deg || !known) {
    throw NmeaProblem{
        "'" + std::string(text) + "," + std::string(hemisphere) +
        "' is not an angle; expected degrees and minutes within " +
        std::to_string(static_cast<int>(largest_deg)) + " deg, " + positive +
        " or " + negative};
  }
  return (hemisphere[0] == negative ? -angle : angle) * kDegree;
}

int NmeaDay(int year, int month, int day) {
  const std::chrono::year_month_day date{
      std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
      std::chrono::day(static_cast<unsigned>(day))};
  if (month < 1 || day < 1 || !date.ok()) {
    throw NmeaProblem{"the date is none; expected day, month, year"};
  }
  return static_cast<int>(
      std::chrono::sys_days(date).time_since_epoch().count());
}

int NmeaDayOfRmc(std::string_view text) {
  const int value =
      static_cast<int>(std::clamp(NmeaNumber(text, "the date"), -1.0, 1e6));
  if (text.size() != 6 || value < 0) {
    throw NmeaProblem{"'" + std::string(text) +
                      "' is not a date; expected ddmmyy"};
  }
  const int year = value % 100;
  return NmeaDay(year + (year < 80 ? 2000 : 1900), value / 100 % 100,
                 value / 10000);
}

}  // namespace hindsight
