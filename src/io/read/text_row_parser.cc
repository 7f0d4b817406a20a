#include "io/read/text_row_parser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "io/read/date_text.h"
#include "io/read/text_format.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

std::string Plural(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " column" : " columns");
}

int TimeColumns(TableLayout::Clock clock) {
  switch (clock) {
    case TableLayout::Clock::kNone:
      return 0;
    case TableLayout::Clock::kSeconds:
    case TableLayout::Clock::kMinutes:
    case TableLayout::Clock::kIso:
    case TableLayout::Clock::kIsoUtc:
    case TableLayout::Clock::kDays:
    case TableLayout::Clock::kOfDay:
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
  if (const auto stamp = ParseDate(first, second, utc, layout.date_order))
    return stamp;
  // With a zone behind.
  return ParseIsoTime(std::string(first) + "T" + std::string(second), utc,
                      layout.date_order);
}

/// GPS time since 1980-01-06 of days since `first_day`, UTC.
std::optional<Stamp> StampOfDays(std::string_view text, double first_day) {
  const auto days = ParseNumber(text);
  if (!days) return std::nullopt;
  const double seconds = (*days - first_day) * static_cast<double>(kDaySeconds);
  if (!IsTime(seconds)) return std::nullopt;
  return GpsFromUnix({0, seconds});
}

/// Of a count of units longer than a second.
std::optional<Stamp> StampOfMinutes(std::string_view text, double unit) {
  const auto count = ParseNumber(text);
  if (!count || !IsTime(*count * unit)) return std::nullopt;
  const double whole = std::floor(*count * unit);
  return Stamp{static_cast<std::int64_t>(whole), *count * unit - whole};
}

/// Of the two columns in the order in which they stand.
std::optional<Stamp> StampOfParts(std::string_view first,
                                  std::string_view second,
                                  const TableLayout& layout) {
  if (layout.clock_column < layout.time_column) std::swap(first, second);
  auto stamp = ParseStamp(first, 1);
  const auto rest = ParseNumber(second);
  if (!stamp || stamp->fraction != 0.0 || !rest || *rest < 0.0 ||
      *rest * layout.rest_unit >= 1.0) {
    return std::nullopt;
  }
  stamp->fraction = *rest * layout.rest_unit;
  return stamp;
}

}  // namespace

TextRowParser::TextRowParser(TableLayout layout, bool allow_absent)
    : layout_(std::move(layout)), allow_absent_(allow_absent) {
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
  for (const TableLayout::Field& field : layout_.fields) {
    if (field.column < 0) continue;
    wanted_[static_cast<std::size_t>(field.column)] = field.is_place ? 3 : 1;
  }
  if (time_columns > 0) {
    wanted_[static_cast<std::size_t>(layout_.time_column)] = 2;
  }
  if (time_columns > 1) wanted_[static_cast<std::size_t>(second)] = 2;
  if (layout_.column_count > 0) FixColumnCount(layout_.column_count);
}

void TextRowParser::FixColumnCount(int count) {
  layout_.column_count = count;
  plain_ = PlainRows(layout_);
}

std::string TextRowParser::Parse(std::string_view line, Scratch* scratch,
                                 std::span<double> values, Stamp* stamp,
                                 int* columns, std::size_t* last_length) const {
  if (plain_.Read(line, values, stamp, last_length)) {
    *columns = layout_.column_count;
    return "";
  }
  *last_length = LastLength(line);
  return ParseAny(line, scratch, values, stamp, columns);
}

/// By hand: find_last_of looks each character up in the set by a call.
std::size_t TextRowParser::LastLength(std::string_view line) const {
  std::size_t length = 0;
  while (length < line.size()) {
    const char c = line[line.size() - 1 - length];
    if (c == layout_.delimiter || c == ' ' || c == '\t') break;
    ++length;
  }
  return length;
}

std::string TextRowParser::ParseAny(std::string_view line, Scratch* scratch,
                                    std::span<double> values, Stamp* stamp,
                                    int* columns) const {
  if (layout_.decimal == ',') {
    scratch->pointed = line;
    std::replace(scratch->pointed.begin(), scratch->pointed.end(), ',', '.');
    line = scratch->pointed;
  }
  TextTokens tokens(line, layout_.delimiter, layout_.comma_is_blank);
  scratch->raw.resize(wanted_.size());
  scratch->time_tokens.clear();
  std::size_t column = 0;
  for (; !tokens.AtEnd(); ++column) {
    const char wanted = column < wanted_.size() ? wanted_[column] : char{0};
    if (wanted == 0) {
      tokens.Next();
    } else if (wanted == 2) {
      scratch->time_tokens.push_back(tokens.Next());
    } else if (tokens.NextNumber(&scratch->raw[column])) {
      if (IsBad(scratch->raw[column])) scratch->raw[column] = kAbsent;
    } else {
      const std::string_view token = tokens.Next();
      auto number = ParseNumber(token);
      if (!number && wanted == 3) number = ParsePlace(token);
      if (!number && !(allow_absent_ && IsAbsentWord(token))) {
        return ColumnName(static_cast<int>(column)) + ": '" +
               std::string(token) + "' is not a finite number" +
               (token.find(',') == token.npos
                    ? ""
                    : "; decimal commas are read with `decimal: comma`");
      }
      if (number && IsBad(*number)) number.reset();
      scratch->raw[column] = number.value_or(kAbsent);
    }
  }
  *columns = static_cast<int>(column);
  const auto expected = static_cast<std::size_t>(layout_.column_count);
  if (expected == 0 ? column < wanted_.size() : column != expected) {
    return "found " + Plural(column) + ", expected " +
           (expected == 0 ? "at least " + std::to_string(wanted_.size())
                          : std::to_string(expected));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const TableLayout::Field& field = layout_.fields[i];
    if (field.column < 0) {
      values[i] = kAbsent;
      continue;
    }
    const double raw = scratch->raw[static_cast<std::size_t>(field.column)];
    values[i] =
        field.factor * (field.has_minutes ? FromDegreesMinutes(raw) : raw);
  }
  return ParseTime(scratch->time_tokens, stamp);
}

bool TextRowParser::IsBad(double value) const {
  return std::find(layout_.bad_values.begin(), layout_.bad_values.end(),
                   value) != layout_.bad_values.end();
}

std::string TextRowParser::ParseTime(
    const std::vector<std::string_view>& time_tokens, Stamp* out) const {
  std::optional<Stamp> stamp;
  switch (layout_.clock) {
    case TableLayout::Clock::kNone:
      return "";
    case TableLayout::Clock::kSeconds:
      stamp = ParseStamp(time_tokens[0], layout_.ticks_per_second);
      break;
    case TableLayout::Clock::kMinutes:
      stamp = StampOfMinutes(time_tokens[0], layout_.long_unit);
      break;
    case TableLayout::Clock::kSplit:
      stamp = StampOfParts(time_tokens[0], time_tokens[1], layout_);
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
                           layout_.clock == TableLayout::Clock::kIsoUtc,
                           layout_.date_order);
      break;
    case TableLayout::Clock::kDays:
      stamp = StampOfDays(time_tokens[0], layout_.first_day);
      break;
    case TableLayout::Clock::kOfDay:
      stamp = ParseTimeOfDay(time_tokens[0]);
      break;
  }
  if (!stamp) {
    std::string text(time_tokens[0]);
    if (time_tokens.size() > 1) text += " " + std::string(time_tokens[1]);
    return ColumnName(layout_.time_column) + ": '" + text + "' is not a time";
  }
  // One by one: copied as a whole, just after it was written in two, the stamp waits
  // for all stores before.
  out->seconds = stamp->seconds;
  out->fraction = stamp->fraction;
  return "";
}

std::string TextRowParser::ColumnName(int column) const {
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

}  // namespace hindsight
