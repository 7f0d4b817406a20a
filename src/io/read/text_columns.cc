#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/text_layout.h"
#include "io/read/text_tokens.h"
#include "io/read/time_scale.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestRows = 3;
/// Lines by which the shape of the table is told.
constexpr std::size_t kShapeLines = 60;

struct Word {
  /// Nothing where nothing stands.
  std::optional<FileColumn::Holds> holds;
  double value = kMissing;
  bool zoned = false;

  bool IsText() const { return holds == FileColumn::Holds::kText; }
};

/// UTC seconds since 1970.
double UnixFromGps(const Stamp& gps) {
  const double seconds = gps.Since({}) + static_cast<double>(kGpsEpochUnix);
  const auto whole = static_cast<std::int64_t>(std::floor(seconds));
  return seconds - LeapSeconds(whole - LeapSeconds(whole));
}

/// A date with its time of day, or one of the two.
std::optional<Word> ParseTimeWord(std::string_view token) {
  using enum FileColumn::Holds;
  constexpr std::size_t kShortest = 8;
  const std::size_t sign = token.find_first_of("-/:");
  if (token.size() < kShortest || sign == token.npos || sign == 0) {
    return std::nullopt;
  }
  const auto seconds = [](const Stamp& as_written) {
    return as_written.Since({}) + static_cast<double>(kGpsEpochUnix);
  };
  if (const auto stamp = ParseIsoTime(token, false)) {
    return Word{kDates, seconds(*stamp), false};
  }
  if (const auto stamp = ParseIsoTime(token, true)) {
    return Word{kDates, UnixFromGps(*stamp), true};
  }
  if (const auto stamp = ParseDate(token, "00:00:00", false)) {
    return Word{kDays, seconds(*stamp), false};
  }
  const std::string on_first_day = "1970-01-01T" + std::string(token);
  if (const auto stamp = ParseIsoTime(on_first_day, false)) {
    return Word{kTimesOfDay, seconds(*stamp), false};
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
  return {kText};
}

/// The words of a line. False of one that holds no numbers, or not more than
/// words of text beside them, as titles and notes do.
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

struct Shape {
  char delimiter = ',';
  std::vector<bool> is_text;  ///< per column
};

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

/// What most of the first lines that hold numbers look like.
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

/// A unit of anything that is recorded, or no word.
bool IsUnit(std::string_view word) {
  using enum Quantity;
  if (word.empty() || word == "1" || word == "-") return true;
  constexpr std::array kRecorded = {kTime,         kLength, kSpeed,
                                    kAcceleration, kAngle,  kAngularRate,
                                    kMagneticField};
  return std::any_of(kRecorded.begin(), kRecorded.end(),
                     [&](Quantity quantity) {
                       return UnitFactor(word, quantity).has_value();
                     });
}

class TextColumns {
 public:
  explicit TextColumns(const std::string& path) : lines_(path) {}

  std::optional<FileColumns> Read() {
    std::vector<std::string> first;
    std::string_view line;
    while (first.size() < kShapeLines && lines_.Next(&line)) {
      first.emplace_back(line);
    }
    const auto shape = FindShape(first);
    if (!shape) return std::nullopt;
    shape_ = *shape;
    found_.format = &ColumnsFormat();
    if (shape_.delimiter == '\t') found_.delimiter = "tab";
    found_.columns.resize(columns());
    for (std::size_t i = 0; i < columns(); ++i) {
      if (shape_.is_text[i]) {
        found_.columns[i].holds = FileColumn::Holds::kText;
      }
    }
    is_known_ = shape_.is_text;
    for (const std::string& early : first) Take(early, true);
    while (found_.complete && lines_.Next(&line)) {
      Take(line, lines_.terminated());
    }
    if (found_.rows < kFewestRows) return std::nullopt;
    Finish();
    return std::move(found_);
  }

 private:
  std::size_t columns() const { return shape_.is_text.size(); }

  void Take(std::string_view line, bool terminated) {
    ++number_;
    if (IsComment(line)) {
      if (found_.rows == 0 && !Trim(line).empty()) {
        comment_ = Trim(line);
        comment_.erase(0, comment_.find_first_not_of("#%/"));
      }
      return;
    }
    const bool numbers = ParseRow(line, shape_.delimiter, &words_);
    if (!numbers || words_.size() != columns() || !HoldsTheSame()) {
      if (found_.rows == 0) {
        above_title_ = std::move(title_);
        title_ = line;
        ++early_;
      } else if (terminated) {
        ++found_.text_rows;
      } else {
        found_.cut_tail = true;
      }
      return;
    }
    if (found_.rows == 0) found_.skip_lines = number_ - 1;
    for (std::size_t i = 0; i < words_.size(); ++i) TakeWord(i);
    ++found_.rows;
    found_.complete = found_.rows * columns() < kMostProbedNumbers;
  }

  void TakeWord(std::size_t i) {
    FileColumn& column = found_.columns[i];
    const bool is_text = column.holds == FileColumn::Holds::kText;
    if (!is_known_[i] && words_[i].holds) {
      column.holds = *words_[i].holds;
      column.zoned = words_[i].zoned;
      is_known_[i] = true;
    }
    column.values.push_back(is_text ? kMissing : words_[i].value);
  }

  /// Numbers where the rows before have numbers, times where they have times.
  bool HoldsTheSame() const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const Word& word = words_[i];
      const FileColumn& column = found_.columns[i];
      if (!word.holds || column.holds == FileColumn::Holds::kText) continue;
      if (word.IsText()) return false;
      if (is_known_[i] &&
          (*word.holds != column.holds || word.zoned != column.zoned)) {
        return false;
      }
    }
    return true;
  }

  void Finish() {
    NameColumns();
    SkipZeroRows();
    if (early_ > 0 && !titled_) {
      found_.remarks.emplace_back(
          "the lines before the first whole row of numbers are passed over");
    }
    if (found_.cut_tail) {
      found_.remarks.emplace_back("the last line is cut off and left out");
    }
    if (found_.text_rows > 0) {
      found_.remarks.push_back(
          std::to_string(found_.text_rows) +
          " rows further down are no rows of numbers (notes, repeated titles) "
          "and left out");
    }
  }

  /// Where the last line before the numbers holds units, the line above it with
  /// these in brackets.
  void TakeUnitsIntoTitle() {
    const auto names = SplitLine(above_title_, shape_.delimiter);
    const auto units = SplitLine(title_, shape_.delimiter);
    if (names.size() != units.size() ||
        !std::all_of(units.begin(), units.end(), IsUnit)) {
      return;
    }
    std::string title;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i > 0) title += shape_.delimiter;
      title += names[i];
      if (!units[i].empty()) title.append("[").append(units[i]).append("]");
    }
    title_ = std::move(title);
  }

  /// By the line before the numbers, if it has as many words, or one less than
  /// the rows, whose last word is then empty.
  void NameColumns() {
    TakeUnitsIntoTitle();
    for (std::size_t i = 0; i < found_.columns.size(); ++i) {
      found_.columns[i].reference = std::to_string(i + 1);
    }
    for (const std::string& text : {title_, comment_}) {
      const auto titles = SplitLine(text, shape_.delimiter);
      std::vector<Word> none;
      if (titles.size() + 1 < columns() || titles.size() > columns() + 1 ||
          ParseRow(text, shape_.delimiter, &none)) {
        continue;
      }
      titled_ = true;
      // One title may stand for a date and the time of day behind it.
      const bool shared = titles.size() + 1 == columns() && SharesTitle();
      for (std::size_t i = 0, at = 0; i < columns() && at < titles.size();
           ++i, ++at) {
        found_.columns[i].title = Trim(titles[at]);
        if (shared && found_.columns[i].holds == FileColumn::Holds::kDays) {
          found_.columns[++i].title = Trim(titles[at]);
        }
      }
      return;
    }
  }

  /// Whether a date and a time of day are one word to whoever reads blanks.
  bool SharesTitle() const {
    for (std::size_t i = 0; i + 1 < columns(); ++i) {
      if (found_.columns[i].holds == FileColumn::Holds::kDays) {
        return shape_.delimiter == ' ' &&
               found_.columns[i + 1].holds == FileColumn::Holds::kTimesOfDay;
      }
    }
    return false;
  }

  /// Rows at the start in which every column that is not zero later is zero,
  /// but for those that count.
  void SkipZeroRows() {
    constexpr std::size_t kMost = 10;
    std::vector<const std::vector<double>*> sensed;
    for (const FileColumn& column : found_.columns) {
      const auto& v = column.values;
      const bool counts = std::is_sorted(v.begin(), v.end());
      const auto zeros = std::count(v.begin(), v.end(), 0.0);
      if (!counts && static_cast<std::size_t>(zeros) < v.size() / 10) {
        sensed.push_back(&v);
      }
    }
    std::size_t rows = 0;
    while (rows < std::min(kMost, found_.rows / 2) && sensed.size() >= 3 &&
           std::count_if(sensed.begin(), sensed.end(),
                         [&](const auto* v) { return (*v)[rows] == 0.0; }) >=
               static_cast<std::ptrdiff_t>(
                   std::min<std::size_t>(sensed.size(), 6))) {
      ++rows;
    }
    if (rows == 0) return;
    for (FileColumn& column : found_.columns) {
      column.values.erase(
          column.values.begin(),
          column.values.begin() + static_cast<std::ptrdiff_t>(rows));
    }
    found_.rows -= rows;
    found_.skip_lines += static_cast<int>(rows);
    found_.remarks.push_back("the first " + std::to_string(rows) +
                             (rows == 1 ? " row holds" : " rows hold") +
                             " zeros alone and is left out");
  }

  TextLines lines_;
  Shape shape_;
  FileColumns found_;
  std::vector<Word> words_;
  std::vector<bool> is_known_;  ///< per column: what it holds
  std::string title_;
  std::string above_title_;
  std::string comment_;
  bool titled_ = false;
  int number_ = 0;
  int early_ = 0;
};

}  // namespace

std::optional<FileColumns> ReadTextColumns(const std::string& path) {
  return TextColumns(path).Read();
}

}  // namespace hindsight
