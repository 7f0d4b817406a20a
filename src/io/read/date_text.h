#ifndef HINDSIGHT_IO_READ_DATE_TEXT_H_
#define HINDSIGHT_IO_READ_DATE_TEXT_H_

#include <optional>
#include <string_view>

#include "io/read/time_scale.h"

namespace hindsight {

/// In which order a date without its year in front is written; kYearFirst: such
/// dates are none, but for 29.06.2025, which is written by nobody else.
enum class DateOrder { kYearFirst, kDayFirst, kMonthFirst };

/// GPS time since 1980-01-06 of a calendar date and time of day; `utc` says in
/// which scale. Dates are "yyyy-mm-dd", "dd.mm.yyyy" and "29-Jun-2025", also with
/// '/' or '-' as `order` says; times of day "hh:mm:ss[.sss]", also with " AM" or " PM" behind;
/// one digit will do for a month, a day and an hour. Nothing if the text is
/// something else, or no such date.
std::optional<Stamp> ParseDate(std::string_view date, std::string_view clock,
                               bool utc,
                               DateOrder order = DateOrder::kYearFirst);

/// Time since midnight of such a time of day or of "hhmmss.sss"; nothing if it is
/// none.
std::optional<Stamp> ParseTimeOfDay(std::string_view clock);

/// GPS time since 1980-01-06 of date and time of day in one word, as ISO 8601 writes
/// it, "2025-07-08T19:34:21.854", or with a blank in place of the T, in the scale
/// that `utc` says; in UTC also with "Z" or an offset as "+02:00" behind. Nothing if
/// it is none.
std::optional<Stamp> ParseIsoTime(std::string_view text, bool utc,
                                  DateOrder order = DateOrder::kYearFirst);

/// "2025-07-08 19:34:21.854 GPST" or "... UTC"; nothing if it is neither.
std::optional<Stamp> ParseDateTime(std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_DATE_TEXT_H_
