#include "io/read/text_table.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>

#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

/// Walks over the tokens of a line without copying them.
class Tokens {
 public:
  Tokens(std::string_view line, char delimiter, bool comma_is_blank)
      : p_(line.data()),
        end_(line.data() + line.size()),
        delimiter_(delimiter),
        comma_is_blank_(comma_is_blank) {
    if (delimiter_ == ' ') SkipSeparators();
  }

  bool AtEnd() const { return finished_ || (delimiter_ == ' ' && p_ == end_); }

  bool IsSeparator(char c) const {
    return delimiter_ == ' ' ? IsBlank(c) || (comma_is_blank_ && c == ',')
                             : c == delimiter_;
  }

  std::string_view Next() {
    const char* begin = p_;
    while (p_ != end_ && !IsSeparator(*p_)) ++p_;
    const std::string_view token(begin, static_cast<std::size_t>(p_ - begin));
    Advance();
    return delimiter_ == ' ' ? token : Trim(token);
  }

  /// Reads the next token as a number without looking for its end first; falls
  /// back to false, in place, for anything unusual.
  bool NextNumber(double* value) {
    const char* p = p_;
    while (p != end_ && IsBlank(*p)) ++p;
    const auto result = fast_float::from_chars(p, end_, *value);
    if (result.ec != std::errc() || !std::isfinite(*value)) return false;
    p = result.ptr;
    if (delimiter_ != ' ') {
      while (p != end_ && IsBlank(*p) && *p != delimiter_) ++p;
    }
    if (p != end_ && !IsSeparator(*p)) return false;
    p_ = p;
    Advance();
    return true;
  }

 private:
  void SkipSeparators() {
    while (p_ != end_ && IsSeparator(*p_)) ++p_;
  }
  void Advance() {
    if (delimiter_ == ' ') {
      SkipSeparators();
    } else if (p_ == end_) {
      finished_ = true;
    } else {
      ++p_;
    }
  }

  const char* p_;
  const char* end_;
  char delimiter_;
  bool comma_is_blank_;
  bool finished_ = false;
};

bool IsAbsent(std::string_view token) {
  return token.empty() || token == "nan" || token == "NaN" || token == "NAN" ||
         token == "-nan";
}

std::string Plural(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " column" : " columns");
}

/// As a line of titles.
bool HoldsNoNumber(std::string_view line, char delimiter) {
  const std::vector<std::string_view> words = SplitLine(line, delimiter);
  return std::none_of(words.begin(), words.end(), [](std::string_view word) {
    return ParseNumber(word).has_value();
  });
}

int TimeColumns(TableLayout::Clock clock) {
  switch (clock) {
    case TableLayout::Clock::kNone:
      return 0;
    case TableLayout::Clock::kSeconds:
    case TableLayout::Clock::kIso:
    case TableLayout::Clock::kIsoUtc:
      return 1;
    default:
      return 2;
  }
}

/// Of the two columns in the order in which they stand.
std::optional<Stamp> DateOf(std::string_view first, std::string_view second,
                            const TableLayout& layout) {
  const bool utc = layout.clock == TableLayout::Clock::kDateUtc;
  const bool clock_first =
      layout.clock_column >= 0 && layout.clock_column < layout.time_column;
  if (clock_first) std::swap(first, second);
  if (const auto stamp = ParseDate(first, second, utc)) return stamp;
  // With a zone behind.
  return ParseIsoTime(std::string(first) + "T" + std::string(second), utc);
}

}  // namespace

char GuessDelimiter(std::string_view line) {
  for (const char candidate : {',', ';'}) {
    if (line.find(candidate) != line.npos) return candidate;
  }
  return ' ';
}

std::vector<std::string_view> SplitLine(std::string_view line, char delimiter,
                                        bool comma_is_blank) {
  std::vector<std::string_view> tokens;
  Tokens walk(line, delimiter, comma_is_blank);
  while (!walk.AtEnd()) tokens.push_back(walk.Next());
  return tokens;
}

bool IsComment(std::string_view line) {
  const std::string_view text = Trim(line);
  return text.empty() || text.front() == '#' || text.front() == '%';
}

TextTable::TextTable(TextLines* lines, TableLayout layout, Options options,
                     std::string first_row)
    : lines_(lines),
      layout_(std::move(layout)),
      options_(options),
      first_row_(std::move(first_row)) {
  values_.assign(layout_.fields.size(), kAbsent);
  int last = -1;
  for (const TableLayout::Field& field : layout_.fields) {
    last = std::max(last, field.column);
  }
  const int time_columns = TimeColumns(layout_.clock);
  const int second = layout_.clock_column >= 0 ? layout_.clock_column
                                               : layout_.time_column + 1;
  if (time_columns > 0) last = std::max(last, layout_.time_column);
  if (time_columns > 1) last = std::max(last, second);
  wanted_.assign(static_cast<std::size_t>(last + 1), 0);
  raw_.assign(wanted_.size(), kAbsent);
  for (const TableLayout::Field& field : layout_.fields) {
    if (field.column >= 0) wanted_[static_cast<std::size_t>(field.column)] = 1;
  }
  if (time_columns > 0) {
    wanted_[static_cast<std::size_t>(layout_.time_column)] = 2;
  }
  if (time_columns > 1) wanted_[static_cast<std::size_t>(second)] = 2;
}

bool TextTable::NextLine(std::string_view* line) {
  if (!first_row_.empty()) {
    *line = first_row_;
  } else {
    do {
      if (!lines_->Next(line)) return false;
    } while (IsComment(*line));
  }
  line_ = lines_->number();
  if (first_length_ == 0) first_length_ = line->size() + 1;
  return true;
}

bool TextTable::Next() {
  std::string_view line;
  std::string problem;
  while (true) {
    if (!NextLine(&line)) return false;
    const bool good = Parse(line, &problem) && IsLastValueWhole(line, &problem);
    first_row_.clear();
    if (good) return true;
    const bool cut = !lines_->terminated() && options_.allow_truncated_tail;
    if (!options_.drop_text || cut) break;
    ++texts_;
  }
  const bool first = layout_.column_count == 0;
  if (first && HoldsNoNumber(line, layout_.delimiter)) {
    problem +=
        "; a line of titles above columns that are counted is passed "
        "over by skip_lines: " +
        std::to_string(line_);
  }
  if (lines_->terminated()) Fail(problem);
  if (!options_.allow_truncated_tail) {
    Fail("the last line is truncated: " + problem +
         " (allow_truncated_tail: true drops it)");
  }
  ++truncated_;
  return false;
}

bool TextTable::IsLastValueWhole(std::string_view line, std::string* problem) {
  if (wanted_.empty() ||
      layout_.column_count != static_cast<int>(wanted_.size())) {
    return true;
  }
  // By hand: find_last_of looks each character up in the set by a call.
  std::size_t length = 0;
  while (length < line.size()) {
    const char c = line[line.size() - 1 - length];
    if (c == layout_.delimiter || c == ' ' || c == '\t') break;
    ++length;
  }
  if (!lines_->terminated() && length < shortest_last_value_ &&
      shortest_last_value_ != kNoLength) {
    *problem = ColumnName(static_cast<int>(wanted_.size()) - 1) + ": '" +
               std::string(line.substr(line.size() - length)) +
               "' is shorter than in all lines before, and no line end follows";
    return false;
  }
  shortest_last_value_ = std::min(shortest_last_value_, length);
  return true;
}

bool TextTable::Parse(std::string_view line, std::string* problem) {
  Tokens tokens(line, layout_.delimiter, layout_.comma_is_blank);
  time_tokens_.clear();
  std::size_t column = 0;
  for (; !tokens.AtEnd(); ++column) {
    const char wanted = column < wanted_.size() ? wanted_[column] : char{0};
    if (wanted == 0) {
      tokens.Next();
    } else if (wanted == 2) {
      time_tokens_.push_back(tokens.Next());
    } else if (!tokens.NextNumber(&raw_[column])) {
      const std::string_view token = tokens.Next();
      const auto number = ParseNumber(token);
      if (!number && !(options_.allow_absent && IsAbsent(token))) {
        *problem = ColumnName(static_cast<int>(column)) + ": '" +
                   std::string(token) + "' is not a finite number";
        return false;
      }
      raw_[column] = number.value_or(kAbsent);
    }
  }
  const auto expected = static_cast<std::size_t>(layout_.column_count);
  if (expected == 0 && column >= wanted_.size()) {
    layout_.column_count = static_cast<int>(column);
  } else if (expected == 0 || column != expected) {
    *problem = "found " + Plural(column) + ", expected " +
               (expected == 0 ? "at least " + std::to_string(wanted_.size())
                              : std::to_string(expected));
    return false;
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const TableLayout::Field& field = layout_.fields[i];
    if (field.column < 0) continue;
    values_[i] = field.factor * raw_[static_cast<std::size_t>(field.column)];
  }
  return ParseTime(time_tokens_, problem);
}

bool TextTable::ParseTime(const std::vector<std::string_view>& time_tokens,
                          std::string* problem) {
  std::optional<Stamp> stamp;
  switch (layout_.clock) {
    case TableLayout::Clock::kNone:
      return true;
    case TableLayout::Clock::kSeconds:
      stamp = ParseStamp(time_tokens[0], layout_.ticks_per_second);
      break;
    case TableLayout::Clock::kWeek: {
      const auto week = ParseNumber(time_tokens[0]);
      stamp = ParseStamp(time_tokens[1], 1);
      if (!week || *week < 0.0 || *week > kLastWeek ||
          *week != std::floor(*week)) {
        stamp.reset();
      }
      if (stamp) {
        stamp->seconds += static_cast<std::int64_t>(*week) * kWeekSeconds;
      }
      break;
    }
    case TableLayout::Clock::kDate:
    case TableLayout::Clock::kDateUtc:
      stamp = DateOf(time_tokens[0], time_tokens[1], layout_);
      break;
    case TableLayout::Clock::kIso:
    case TableLayout::Clock::kIsoUtc:
      stamp = ParseIsoTime(time_tokens[0],
                           layout_.clock == TableLayout::Clock::kIsoUtc);
      break;
  }
  if (!stamp) {
    std::string text(time_tokens[0]);
    if (time_tokens.size() > 1) text += " " + std::string(time_tokens[1]);
    *problem =
        ColumnName(layout_.time_column) + ": '" + text + "' is not a time";
    return false;
  }
  stamp_ = *stamp;
  return true;
}

std::string TextTable::ColumnName(int column) const {
  std::string name = "column " + std::to_string(column + 1);
  if (layout_.clock != TableLayout::Clock::kNone &&
      column == layout_.time_column) {
    return name + " (time)";
  }
  for (const TableLayout::Field& field : layout_.fields) {
    if (field.column == column) return name + " (" + field.name + ")";
  }
  return name;
}

std::vector<LeftOut> TextTable::left_out() const {
  std::vector<LeftOut> left_out;
  if (truncated_ > 0) {
    left_out.push_back({"truncated last line dropped", truncated_});
  }
  if (texts_ > 0) left_out.push_back({"row of text dropped", texts_});
  return left_out;
}

std::size_t TextTable::RowsHint() const {
  // Rows differ in length; a little too much costs address space only.
  return first_length_ == 0
             ? 0
             : lines_->size_hint() / std::max<std::size_t>(first_length_, 2) *
                   11 / 10;
}

}  // namespace hindsight
