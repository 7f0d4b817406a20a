#include "io/read/column_gatherer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "io/read/bad_values.h"
#include "io/read/file_formats.h"
#include "io/read/text_layout.h"
#include "io/read/text_lines.h"
#include "io/read/text_shape.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
/// Lines by which the shape of the table is told, comments aside: at first, and
/// behind how many notes no table is looked for any more.
constexpr std::size_t kShapeLines = 60;
constexpr std::size_t kMostNotes = 16'000;

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

}  // namespace

void ColumnGatherer::Add(std::string_view line, bool terminated) {
  if (shapeless_) return;
  if (shape_) {
    Take(line, terminated);
    return;
  }
  early_lines_.emplace_back(line);
  early_terminated_ = terminated;
  if (IsComment(line)) return;
  // Looked at whenever they have doubled, which costs little more than once.
  const std::size_t next = kShapeLines << early_searches_;
  if (++early_texts_ < next) return;
  ++early_searches_;
  FindShapeOfEarly();
  shapeless_ = !shape_ && early_texts_ >= kMostNotes;
}

void ColumnGatherer::FindShapeOfEarly() {
  shape_ = FindShape(early_lines_);
  if (!shape_) return;
  found_.format = &ColumnsFormat();
  if (shape_->delimiter == '\t') found_.delimiter = "tab";
  found_.columns.resize(columns());
  for (std::size_t i = 0; i < columns(); ++i) {
    if (shape_->is_text[i]) found_.columns[i].holds = FileColumn::Holds::kText;
  }
  is_known_ = shape_->is_text;
  for (std::size_t i = 0; i < early_lines_.size(); ++i) {
    Take(early_lines_[i], early_terminated_ || i + 1 < early_lines_.size());
  }
  early_lines_.clear();
}

std::optional<FileColumns> ColumnGatherer::Finish() {
  if (!shape_ && !early_lines_.empty()) FindShapeOfEarly();
  if (found_.rows < kFewestRows) return std::nullopt;
  ChooseDateOrders();
  NameColumns();
  if (found_.row_word.column < 0) {
    SkipZeroRows();
  } else {
    found_.skip_lines = 0;
  }
  Remark();
  TakeOutBadValues(&found_);
  return std::move(found_);
}

/// The order in which all are dates; of two the one in which they lie closer
/// together; else the day first, but where AM or PM says who wrote it.
void ColumnGatherer::ChooseDateOrders() {
  const auto span = [](const std::vector<double>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    const bool whole = std::none_of(v.begin(), v.end(),
                                    [](double x) { return std::isnan(x); });
    return whole ? *high - *low : std::numeric_limits<double>::infinity();
  };
  for (std::size_t i = 0; i < month_first_.size(); ++i) {
    FileColumn& column = found_.columns[i];
    std::vector<double>& other = month_first_[i];
    if (other.size() != column.values.size() || other.empty()) continue;
    const double by_day = span(column.values);
    const double by_month = span(other);
    column.order_told = by_day != by_month;
    if (by_month < by_day || (!column.order_told && halves_of_day_)) {
      column.values = std::move(other);
      column.date_order = DateOrder::kMonthFirst;
    }
  }
}

void ColumnGatherer::Take(std::string_view line, bool terminated) {
  ++number_;
  if (IsComment(line)) {
    if (found_.rows == 0 && !Trim(line).empty()) {
      comment_ = Trim(line);
      comment_.erase(0, comment_.find_first_not_of("#%/"));
    }
    return;
  }
  const bool numbers = ParseRow(line, shape_->delimiter, &words_);
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
  if (found_.rows == 0) {
    found_.skip_lines = number_ - 1;
    halves_of_day_ =
        line.find("AM") != line.npos || line.find("PM") != line.npos ||
        line.find("am") != line.npos || line.find("pm") != line.npos;
  }
  for (std::size_t i = 0; i < words_.size(); ++i) TakeWord(i);
  ++found_.rows;
  found_.complete = found_.rows * columns() < kMostProbedNumbers;
}

void ColumnGatherer::TakeWord(std::size_t i) {
  FileColumn& column = found_.columns[i];
  const bool is_text = column.holds == FileColumn::Holds::kText;
  if (!is_known_[i] && words_[i].holds) {
    column.holds = *words_[i].holds;
    column.zoned = words_[i].zoned;
    column.date_order = words_[i].order;
    is_known_[i] = true;
  }
  if (words_[i].order == DateOrder::kDayFirst) {
    month_first_.resize(columns());
    month_first_[i].push_back(words_[i].month_first);
  }
  if (words_[i].side != '\0' && words_[i].side != column.side) {
    column.side = column.values.empty() ? words_[i].side : '?';
  }
  column.values.push_back(is_text ? kMissing : words_[i].value);
}

/// Numbers where the rows before have numbers, times where they have times.
bool ColumnGatherer::HoldsTheSame() const {
  for (std::size_t i = 0; i < words_.size(); ++i) {
    const Word& word = words_[i];
    const FileColumn& column = found_.columns[i];
    if (!word.holds || column.holds == FileColumn::Holds::kText) continue;
    if (word.IsText()) return false;
    if (is_known_[i] &&
        (*word.holds != column.holds || word.zoned != column.zoned ||
         word.order != column.date_order)) {
      return false;
    }
  }
  return true;
}

void ColumnGatherer::Remark() {
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
void ColumnGatherer::TakeUnitsIntoTitle() {
  const auto names = SplitLine(above_title_, shape_->delimiter);
  const auto units = SplitLine(title_, shape_->delimiter);
  if (names.size() != units.size() ||
      !std::all_of(units.begin(), units.end(), IsUnit)) {
    return;
  }
  std::string title;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) title += shape_->delimiter;
    title += names[i];
    if (!units[i].empty()) title.append("[").append(units[i]).append("]");
  }
  title_ = std::move(title);
}

/// By the line before the numbers, if it has as many words, or one less than
/// the rows, whose last word is then empty.
void ColumnGatherer::NameColumns() {
  TakeUnitsIntoTitle();
  for (std::size_t i = 0; i < found_.columns.size(); ++i) {
    found_.columns[i].reference = std::to_string(i + 1);
  }
  for (const std::string& text : {title_, comment_}) {
    const auto titles = SplitLine(text, shape_->delimiter);
    std::vector<Word> none;
    if (titles.size() + 1 < columns() || titles.size() > columns() + 1 ||
        ParseRow(text, shape_->delimiter, &none)) {
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
bool ColumnGatherer::SharesTitle() const {
  for (std::size_t i = 0; i + 1 < columns(); ++i) {
    if (found_.columns[i].holds == FileColumn::Holds::kDays) {
      return shape_->delimiter == ' ' &&
             found_.columns[i + 1].holds == FileColumn::Holds::kTimesOfDay;
    }
  }
  return false;
}

/// Rows at the start in which every column that is not zero later is zero,
/// but for those that count.
void ColumnGatherer::SkipZeroRows() {
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

std::optional<FileColumns> ReadTextBeginning(const std::string& path,
                                             long most_lines) {
  TextLines lines(path);
  ColumnGatherer gatherer;
  std::string_view line;
  for (long i = 0; i < most_lines && gatherer.wants_more() && lines.Next(&line);
       ++i) {
    gatherer.Add(line, lines.terminated());
  }
  return gatherer.Finish();
}

std::optional<FileColumns> ReadTextColumns(const std::string& path) {
  return ReadTextBeginning(path, std::numeric_limits<long>::max());
}

}  // namespace hindsight
