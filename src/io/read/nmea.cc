#include "io/read/nmea.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kHalfDay = 43200.0;

/// What is wrong with a sentence; the reader adds file and line.
struct Problem {
  std::string text;
};

/// The fields between '$' and '*', the address first.
std::vector<std::string_view> SplitSentence(std::string_view line) {
  line = Trim(line);
  if (!line.starts_with('$') && !line.starts_with('!')) {
    throw Problem{"is no NMEA sentence; expected '$' at its start"};
  }
  const std::size_t star = line.rfind('*');
  if (star == line.npos) {
    throw Problem{"the sentence has no checksum; expected '*' and two digits"};
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
    throw Problem{"the checksum is not two hexadecimal digits"};
  }
  if (stated != sum) throw Problem{"the checksum is wrong: a damaged sentence"};
  return SplitLine(line.substr(1, star - 1), ',');
}

double Number(std::string_view text, const char* what) {
  const auto number = ParseNumber(text);
  if (!number) {
    throw Problem{std::string(what) + ": '" + std::string(text) +
                  "' is not a finite number"};
  }
  return *number;
}

/// "hhmmss.ss" in seconds of the day.
double TimeOfDay(std::string_view text) {
  const double value = Number(text, "the time");
  const double hours = std::floor(value / 1e4);
  const double minutes = std::floor((value - 1e4 * hours) / 1e2);
  const double seconds = value - 1e4 * hours - 1e2 * minutes;
  if (value < 0.0 || hours > 23.0 || minutes > 59.0 || seconds >= 61.0) {
    throw Problem{"'" + std::string(text) + "' is not a time; expected hhmmss"};
  }
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

/// "dddmm.mmmm" and a hemisphere in radians.
double Angle(std::string_view text, std::string_view hemisphere, char positive,
             char negative, double largest_deg) {
  const double value = Number(text, "an angle");
  const double degrees = std::floor(value / 100.0);
  const double minutes = value - 100.0 * degrees;
  const double angle = degrees + minutes / 60.0;
  const bool known = hemisphere.size() == 1 &&
                     (hemisphere[0] == positive || hemisphere[0] == negative);
  if (value < 0.0 || minutes >= 60.0 || angle > largest_deg || !known) {
    throw Problem{"'" + std::string(text) + "," + std::string(hemisphere) +
                  "' is not an angle; expected degrees and minutes within " +
                  std::to_string(static_cast<int>(largest_deg)) + " deg, " +
                  positive + " or " + negative};
  }
  return (hemisphere[0] == negative ? -angle : angle) * kDegree;
}

/// Days since 1970 of a date.
int Day(int year, int month, int day) {
  const std::chrono::year_month_day date{
      std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
      std::chrono::day(static_cast<unsigned>(day))};
  if (month < 1 || day < 1 || !date.ok()) {
    throw Problem{"the date is none; expected day, month, year"};
  }
  return static_cast<int>(
      std::chrono::sys_days(date).time_since_epoch().count());
}

/// "ddmmyy": the century is that of GPS.
int DayOfRmc(std::string_view text) {
  const int value =
      static_cast<int>(std::clamp(Number(text, "the date"), -1.0, 1e6));
  if (text.size() != 6 || value < 0) {
    throw Problem{"'" + std::string(text) + "' is not a date; expected ddmmyy"};
  }
  const int year = value % 100;
  return Day(year + (year < 80 ? 2000 : 1900), value / 100 % 100,
             value / 10000);
}

/// Counts the days from the first sentence on.
class DayCounter {
 public:
  void Observe(double time_of_day) {
    if (last_ && time_of_day < *last_ - kHalfDay) ++day_;
    if (last_ && time_of_day > *last_ + kHalfDay) --day_;
    last_ = time_of_day;
  }
  /// `date` is that of the sentence just observed.
  void Date(int date) {
    if (!first_date_) first_date_ = date - day_;
    day_ = date - *first_date_;
  }
  int day() const { return day_; }
  std::optional<int> first_date() const { return first_date_; }

 private:
  std::optional<double> last_;
  std::optional<int> first_date_;
  int day_ = 0;
};

class NmeaReader {
 public:
  NmeaReader(TextLines* lines, const std::vector<FieldName>& fields,
             const TextTable::Options& options)
      : lines_(*lines),
        options_(options),
        takes_rmc_(FieldIndex(fields, "speed").has_value()),
        rows_(lines->path(), fields, options.allow_absent) {
    for (const char* field : {"lat", "lon", "h", "speed", "course"}) {
      rows_.Declare(field);
    }
    if (!takes_rmc_) rows_.Declare("quality");
  }

  RowBuffer Read(bool* dated) {
    std::string_view line;
    while (lines_.Next(&line)) {
      if (IsComment(line)) continue;
      try {
        Take(SplitSentence(line));
      } catch (const Problem& problem) {
        if (!lines_.terminated() && options_.allow_truncated_tail) {
          rows_.LeaveOut("truncated last line dropped", 1);
          break;
        }
        throw InputError(lines_.path(), lines_.number(), problem.text);
      }
    }
    if (stamps_.empty()) {
      throw InputError(lines_.path(), 0,
                       std::string("holds no ") + (takes_rmc_ ? "RMC" : "GGA") +
                           " sentence with a fix");
    }
    if (with_sigma_ == stamps_.size()) {
      for (const char* field : {"sigma_n", "sigma_e", "sigma_d", "sigma_h"}) {
        rows_.Declare(field);
      }
    }
    if (with_satellites_ == stamps_.size()) rows_.Declare("satellites");
    rows_.LeaveOut("no fix", without_fix_);
    Stamps();
    *dated = days_.first_date().has_value();
    return std::move(rows_);
  }

 private:
  using Sentence = std::vector<std::string_view>;

  static std::string_view At(const Sentence& sentence, std::size_t i) {
    if (i >= sentence.size()) {
      throw Problem{"found " + std::to_string(sentence.size()) +
                    " fields, expected more"};
    }
    return sentence[i];
  }

  void Take(const Sentence& sentence) {
    const std::string_view address = At(sentence, 0);
    if (address.size() != 5) return;
    const std::string_view type = address.substr(2);
    const bool timed =
        type == "GGA" || type == "RMC" || type == "GST" || type == "ZDA";
    if (!timed || At(sentence, 1).empty()) {
      if (timed && type == (takes_rmc_ ? "RMC" : "GGA")) ++without_fix_;
      return;
    }
    time_of_day_ = TimeOfDay(At(sentence, 1));
    days_.Observe(time_of_day_);
    if (type == "RMC") TakeRmc(sentence);
    if (type == "GGA" && !takes_rmc_) TakeGga(sentence);
    if (type == "GST" && !takes_rmc_) TakeGst(sentence);
    if (type == "ZDA" && !At(sentence, 4).empty()) {
      days_.Date(Day(Integer(sentence[4]), Integer(sentence[3]),
                     Integer(sentence[2])));
    }
  }

  static int Integer(std::string_view text) {
    return static_cast<int>(std::clamp(Number(text, "the date"), -1.0, 1e5));
  }

  void Append() {
    stamps_.emplace_back(days_.day(), time_of_day_);
    rows_.Append({}, lines_.number());
  }

  void TakeRmc(const Sentence& sentence) {
    if (!At(sentence, 9).empty()) days_.Date(DayOfRmc(sentence[9]));
    if (!takes_rmc_) return;
    if (sentence[2] != "A" || sentence[7].empty()) {
      ++without_fix_;
      return;
    }
    Append();
    rows_.Set("speed", Number(sentence[7], "the speed") * kKnot);
    if (!sentence[8].empty()) {
      rows_.Set("course", Number(sentence[8], "the course") * kDegree);
    }
  }

  void TakeGga(const Sentence& sentence) {
    const std::string_view quality = At(sentence, 6);
    if (quality.empty() || quality == "0" || sentence[2].empty()) {
      ++without_fix_;
      return;
    }
    if (At(sentence, 11).empty()) {
      throw Problem{
          "GGA has no geoid separation; expected it, for the height "
          "above the ellipsoid"};
    }
    Append();
    rows_.Set("lat", Angle(sentence[2], sentence[3], 'N', 'S', 90.0));
    rows_.Set("lon", Angle(sentence[4], sentence[5], 'E', 'W', 180.0));
    rows_.Set("h", Number(sentence[9], "the height") +
                       Number(sentence[11], "the geoid separation"));
    rows_.Set("quality", Number(quality, "the quality"));
    if (!sentence[7].empty()) {
      rows_.Set("satellites", Number(sentence[7], "the number of satellites"));
      ++with_satellites_;
    }
    if (gst_ && gst_->time_of_day == time_of_day_) SetSigmas();
  }

  void TakeGst(const Sentence& sentence) {
    if (At(sentence, 8).empty()) return;
    gst_ = Gst{time_of_day_, Number(sentence[6], "the standard deviation"),
               Number(sentence[7], "the standard deviation"),
               Number(sentence[8], "the standard deviation")};
    if (!stamps_.empty() && stamps_.back().second == time_of_day_) SetSigmas();
  }

  void SetSigmas() {
    rows_.Set("sigma_n", gst_->north);
    rows_.Set("sigma_e", gst_->east);
    rows_.Set("sigma_d", gst_->up);
    rows_.Set("sigma_h", gst_->up);
    gst_.reset();
    ++with_sigma_;
  }

  /// The date may be known only after the first rows.
  void Stamps() {
    const auto first = days_.first_date();
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      const auto [day, time_of_day] = stamps_[i];
      rows_.Restamp(i, first ? GpsFromUtc(*first + day, time_of_day)
                             : Stamp{day * std::int64_t{86400}, time_of_day});
    }
  }

  struct Gst {
    double time_of_day, north, east, up;
  };

  TextLines& lines_;
  const TextTable::Options& options_;
  bool takes_rmc_;
  RowBuffer rows_;
  DayCounter days_;
  double time_of_day_ = 0.0;
  std::vector<std::pair<int, double>> stamps_;
  std::optional<Gst> gst_;
  std::size_t with_sigma_ = 0;
  std::size_t with_satellites_ = 0;
  long without_fix_ = 0;
};

}  // namespace

RowBuffer ReadNmea(TextLines* lines, const std::vector<FieldName>& fields,
                   const TextTable::Options& options, bool* dated) {
  return NmeaReader(lines, fields, options).Read(dated);
}

}  // namespace hindsight
