#ifndef HINDSIGHT_IO_READ_TEXT_SHAPE_H_
#define HINDSIGHT_IO_READ_TEXT_SHAPE_H_

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/date_text.h"
#include "io/read/file_columns.h"

namespace hindsight {

/// One word of a line whose columns nobody has declared.
struct Word {
  /// Nothing where nothing stands.
  std::optional<FileColumn::Holds> holds;
  double value = std::numeric_limits<double>::quiet_NaN();
  bool zoned = false;
  /// Of a date as 07/08/2025: kDayFirst, with the value of the month first beside
  /// that of the day first, NaN of what is no date so.
  DateOrder order = DateOrder::kYearFirst;
  double month_first = std::numeric_limits<double>::quiet_NaN();
  /// 'N', 'E', 'S' or 'W' behind a number, which it heeds, or all of a text.
  char side = '\0';

  bool IsText() const { return holds == FileColumn::Holds::kText; }
};

/// The words of a line. False of one that holds no numbers, or not more than
/// words of text beside them, as titles and notes do.
bool ParseRow(std::string_view line, char delimiter, std::vector<Word>* words);

/// What the rows of a text look like.
struct Shape {
  char delimiter = ',';
  std::vector<bool> is_text;  ///< per column
};

/// Rows that make a table.
inline constexpr std::size_t kFewestRows = 3;

/// What most of the first lines that hold numbers look like; nothing where fewer
/// than kFewestRows do.
std::optional<Shape> FindShape(const std::vector<std::string>& lines);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_SHAPE_H_
