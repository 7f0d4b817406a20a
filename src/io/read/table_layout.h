#ifndef HINDSIGHT_IO_READ_TABLE_LAYOUT_H_
#define HINDSIGHT_IO_READ_TABLE_LAYOUT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "io/read/date_text.h"
#include "io/read/row_word.h"

namespace hindsight {

/// Which column of a table holds what. Columns count from 0; -1 is none.
struct TableLayout {
  struct Field {
    std::string name;     ///< of the quantity, for messages
    int column = -1;      ///< -1: the table does not have it
    double factor = 1.0;  ///< to SI, sign included
    /// An angle written as degrees times 100 plus minutes, "4807.038"; the factor is
    /// that of a degree.
    bool has_minutes = false;
    bool is_place = false;  ///< may have N, S, E or W behind it
  };
  std::vector<Field> fields;

  /// How the stamp is written.
  enum class Clock {
    kNone,     ///< there is no stamp: Stamp{}
    kSeconds,  ///< time_column, in 1/ticks_per_second
    kMinutes,  ///< time_column, in `long_unit`
    kSplit,    ///< whole seconds in time_column, the rest in clock_column
    kWeek,     ///< GPS week in time_column, seconds of week after it
    kDate,     ///< yyyy/mm/dd in time_column, hh:mm:ss.sss in another, GPST
    kDateUtc,  ///< the same in UTC
    kIso,      ///< ISO 8601 in time_column, GPST
    kIsoUtc,   ///< the same in UTC
    kDays,     ///< days in time_column, from `first_day`, UTC
    kOfDay,    ///< hh:mm:ss.sss in time_column, since the first midnight
  };
  Clock clock = Clock::kSeconds;
  int time_column = -1;
  int clock_column = -1;    ///< of dates: hh:mm:ss.sss; -1: right of the date
  double rest_unit = 1e-9;  ///< of kSplit [s]
  double long_unit = 60.0;  ///< of kMinutes [s]
  std::int64_t ticks_per_second = 1;
  double first_day = 0.0;  ///< of kDays: where 1970 begins [d]
  DateOrder date_order = DateOrder::kYearFirst;

  char delimiter = ',';                 ///< ' ': any run of blanks
  char decimal = '.';                   ///< or ',', which is no delimiter then
  bool comma_is_blank = false;          ///< with ' ': commas separate too
  RowWord rows = {};                    ///< other lines are another stream's
  std::vector<double> bad_values = {};  ///< numbers that are absent
  /// Columns each row must have; 0: as many as the first row.
  int column_count = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TABLE_LAYOUT_H_
