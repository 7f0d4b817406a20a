#include "io/read/plain_rows.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hindsight {
namespace {

/// A stamp is one number as long as a double holds what is written.
bool IsShortStamp(std::string_view text, double value) {
  constexpr double kLargest = 1e9;
  constexpr std::size_t kShort = 9;  // digits, of which some may be zeros
  return std::abs(value) < kLargest &&
         (text.size() <= kShort || text[0] != '0' || text[1] == '.');
}

/// Reads a finite number and returns where it ends, nullptr where there is none. The
/// sign is no branch, as of most columns no processor guesses it.
const char* ReadNumber(const char* p, const char* end, double* value) {
  if (p == end) return nullptr;
  const bool negative = *p == '-';
  p += negative;
  if (p == end || *p == '-') return nullptr;
  double size = 0.0;
  const auto result = fast_float::from_chars(p, end, size);
  if (result.ec != std::errc() || !std::isfinite(size)) return nullptr;
  constexpr int kSign = 63;
  *value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) |
                                 std::uint64_t{negative} << kSign);
  return result.ptr;
}

}  // namespace

PlainRows::PlainRows(const TableLayout& layout) : delimiter_(layout.delimiter) {
  if (layout.decimal != '.' || !layout.bad_values.empty() ||
      layout.clock != TableLayout::Clock::kSeconds || layout.time_column < 0 ||
      layout.time_column >= layout.column_count) {
    return;
  }
  columns_.resize(static_cast<std::size_t>(layout.column_count));
  columns_[static_cast<std::size_t>(layout.time_column)] = {
      kTime, static_cast<double>(layout.ticks_per_second)};
  bool plain = true;
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    plain = plain && SetField(i, layout.fields[i]);
  }
  // What is skipped between blanks ends at others than the delimiter as well.
  plain = plain &&
          (delimiter_ != ' ' || std::none_of(columns_.begin(), columns_.end(),
                                             [](const Column& column) {
                                               return column.field == kSkipped;
                                             }));
  if (!plain) columns_.clear();
}

/// Whether it is a number in a column of its own, or none.
bool PlainRows::SetField(std::size_t i, const TableLayout::Field& field) {
  if (field.column < 0) {
    absent_.push_back(i);
    return true;
  }
  const auto at = static_cast<std::size_t>(field.column);
  if (field.has_minutes || field.is_place || at >= columns_.size() ||
      columns_[at].field != kSkipped) {
    return false;
  }
  columns_[at] = {static_cast<int>(i), field.factor};
  return true;
}

bool PlainRows::Read(std::string_view row, std::span<double> values,
                     Stamp* stamp, std::size_t* last_length) const {
  const char* p = row.data();
  const char* const end = p + row.size();
  const char* begin = p;
  std::size_t left = columns_.size();
  if (left == 0) return false;
  for (const Column& column : columns_) {
    begin = p;
    if (column.field == kSkipped) {
      if (p == end || *p == '"') return false;
      const void* next =
          std::memchr(p, delimiter_, static_cast<std::size_t>(end - p));
      p = next == nullptr ? end : static_cast<const char*>(next);
    } else {
      double value = 0.0;
      p = ReadNumber(p, end, &value);
      if (p == nullptr) return false;
      if (column.field == kTime) {
        const std::string_view text(begin, static_cast<std::size_t>(p - begin));
        if (!IsShortStamp(text, value)) return false;
        stamp->seconds = 0;
        stamp->fraction = value / column.factor;
      } else {
        values[static_cast<std::size_t>(column.field)] = column.factor * value;
      }
    }
    if (--left == 0) break;
    if (p == end || *p != delimiter_) return false;
    ++p;
  }
  if (p != end) return false;
  for (const std::size_t i : absent_) {
    values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  *last_length = static_cast<std::size_t>(end - begin);
  return true;
}

}  // namespace hindsight
