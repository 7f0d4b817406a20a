#ifndef HINDSIGHT_IO_READ_WRITTEN_DATES_H_
#define HINDSIGHT_IO_READ_WRITTEN_DATES_H_

#include <optional>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"

namespace hindsight {

/// Times that are written as dates, or as times of day.
struct Dates {
  int column = -1;
  int day_column = -1;
  bool numbers = false;  ///< times of day are written as numbers, hhmmss.sss
  std::vector<double> t;
};

/// Dates, or days and times of day, or these alone, also as numbers in a column
/// that a title calls a time; those that do not fall behind from row to row.
std::optional<Dates> FindDates(const FileColumns& file,
                               const std::vector<ColumnMeaning>& meanings);

/// Whether most are the same as the one before, as those in whole seconds are.
bool MostlyStand(const std::vector<double>& t);

/// Whether there is no day.
bool IsOfDay(const Dates& dates, const FileColumns& file);

/// Times of day [s], or `numbers` hhmmss.sss, that go on counting over midnight.
void CountFromMidnight(bool numbers, std::vector<double>* t);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_WRITTEN_DATES_H_
