#ifndef HINDSIGHT_IO_READ_STAMP_COLUMNS_H_
#define HINDSIGHT_IO_READ_STAMP_COLUMNS_H_

#include <optional>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/split_seconds.h"
#include "io/read/written_dates.h"

namespace hindsight {

/// Where the stamps stand: dates, whole seconds and their rest, or one column.
struct StampColumns {
  int column = -1;  ///< the first of them; -1: nowhere
  std::optional<Dates> dates;
  std::optional<SplitSeconds> split;
};

StampColumns FindStampColumns(const FileColumns& file,
                              const std::vector<ColumnMeaning>& meanings);

/// What stands there: seconds of dates and of split stamps, else the numbers
/// of the column.
const std::vector<double>& TimesIn(const StampColumns& found,
                                   const FileColumns& file);

/// Whether a column counts weeks.
bool HasWeek(const std::vector<ColumnMeaning>& meanings);

/// Seconds of the week start again from zero on Sunday.
void GoOnOverWeeks(std::vector<double>* t);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_STAMP_COLUMNS_H_
