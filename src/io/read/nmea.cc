#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/units.h"
#include "io/read/file_formats.h"
#include "io/read/nmea_sentence.h"
#include "io/read/open_text.h"
#include "io/read/text_tokens.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kHalfDay = 43200.0;

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
        Take(SplitNmea(line));
      } catch (const NmeaProblem& problem) {
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
      throw NmeaProblem{"found " + std::to_string(sentence.size()) +
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
    time_of_day_ = NmeaTimeOfDay(At(sentence, 1));
    days_.Observe(time_of_day_);
    if (type == "RMC") TakeRmc(sentence);
    if (type == "GGA" && !takes_rmc_) TakeGga(sentence);
    if (type == "GST" && !takes_rmc_) TakeGst(sentence);
    if (type == "ZDA" && !At(sentence, 4).empty()) {
      days_.Date(NmeaDay(Integer(sentence[4]), Integer(sentence[3]),
                         Integer(sentence[2])));
    }
  }

  static int Integer(std::string_view text) {
    return static_cast<int>(
        std::clamp(NmeaNumber(text, "the date"), -1.0, 1e5));
  }

  void Append() {
    stamps_.emplace_back(days_.day(), time_of_day_);
    rows_.Append({}, lines_.number());
  }

  void TakeRmc(const Sentence& sentence) {
    if (!At(sentence, 9).empty()) days_.Date(NmeaDayOfRmc(sentence[9]));
    if (!takes_rmc_) return;
    if (sentence[2] != "A" || sentence[7].empty()) {
      ++without_fix_;
      return;
    }
    Append();
    rows_.Set("speed", NmeaNumber(sentence[7], "the speed") * kKnot);
    if (!sentence[8].empty()) {
      rows_.Set("course", NmeaNumber(sentence[8], "the course") * kDegree);
    }
  }

  void TakeGga(const Sentence& sentence) {
    const std::string_view quality = At(sentence, 6);
    if (quality.empty() || quality == "0" || sentence[2].empty()) {
      ++without_fix_;
      return;
    }
    if (At(sentence, 11).empty()) {
      throw NmeaProblem{
          "GGA has no geoid separation; expected it, for the height "
          "above the ellipsoid"};
    }
    Append();
    rows_.Set("lat", NmeaAngle(sentence[2], sentence[3], 'N', 'S', 90.0));
    rows_.Set("lon", NmeaAngle(sentence[4], sentence[5], 'E', 'W', 180.0));
    rows_.Set("h", NmeaNumber(sentence[9], "the height") +
                       NmeaNumber(sentence[11], "the geoid separation"));
    rows_.Set("quality", NmeaNumber(quality, "the quality"));
    if (!sentence[7].empty()) {
      rows_.Set("satellites",
                NmeaNumber(sentence[7], "the number of satellites"));
      ++with_satellites_;
    }
    if (gst_ && gst_->time_of_day == time_of_day_) SetSigmas();
  }

  void TakeGst(const Sentence& sentence) {
    if (At(sentence, 8).empty()) return;
    gst_ = Gst{time_of_day_, NmeaNumber(sentence[6], "the standard deviation"),
               NmeaNumber(sentence[7], "the standard deviation"),
               NmeaNumber(sentence[8], "the standard deviation")};
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

std::optional<FoundStream> RecogniseNmea(const TextProbe& probe) {
  bool gga = false;
  bool rmc = false;
  for (const std::string& line : probe.lines) {
    if (!line.starts_with('$') || line.size() < 6) return std::nullopt;
    gga = gga || line.substr(3, 3) == "GGA";
    rmc = rmc || line.substr(3, 3) == "RMC";
  }
  FoundStream found;
  found.sigmas = false;
  if (gga) found.kinds.push_back(&PositionKind());
  if (rmc) found.kinds.push_back(&SpeedCourseKind());
  if (found.kinds.empty()) return std::nullopt;
  return found;
}

}  // namespace

const FileFormat& NmeaFormat() {
  static const FileFormat kFormat = {
      .name = "nmea",
      .help = "NMEA 0183: GGA with geoid separation, GST, RMC",
      .streams = "position, height, speed and course",
      .dated = true,
      .open =
          [](const TableRequest& request) {
            const OpenedTable opened = OpenLines(request);
            bool dated = false;
            RowBuffer rows =
                NmeaReader(opened.lines.get(), request.fields, request.options)
                    .Read(&dated);
            return OpenBuffer(std::move(rows), dated);
          },
      .recognise_text = RecogniseNmea};
  return kFormat;
}

}  // namespace hindsight
