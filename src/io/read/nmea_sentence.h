#ifndef HINDSIGHT_IO_READ_NMEA_SENTENCE_H_
#define HINDSIGHT_IO_READ_NMEA_SENTENCE_H_

#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// What is wrong with a sentence; the reader adds file and line. All functions
/// here throw it.
struct NmeaProblem {
  std::string text;
};

/// The fields between '$' and '*', the address first; the checksum must fit.
std::vector<std::string_view> SplitNmea(std::string_view line);

/// A finite number; `what` it is, for the message.
double NmeaNumber(std::string_view text, const char* what);

/// "hhmmss.ss" in seconds of the day.
double NmeaTimeOfDay(std::string_view text);

/// "dddmm.mmmm" and a hemisphere [rad].
double NmeaAngle(std::string_view text, std::string_view hemisphere,
                 char positive, char negative, double largest_deg);

/// Days since 1970 of a date.
int NmeaDay(int year, int month, int day);

/// The same of "ddmmyy": the century is that of GPS.
int NmeaDayOfRmc(std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_NMEA_SENTENCE_H_
