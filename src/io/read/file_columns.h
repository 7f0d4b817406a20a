#ifndef HINDSIGHT_IO_READ_FILE_COLUMNS_H_
#define HINDSIGHT_IO_READ_FILE_COLUMNS_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/read/date_text.h"
#include "io/read/row_word.h"

namespace hindsight {

struct FileFormat;

/// One column as a file holds it.
struct FileColumn {
  /// What stands in it: numbers, or a time as ISO 8601 writes it: date and time
  /// of day in one word, or one of the two; or other text.
  enum class Holds { kNumbers, kDates, kDays, kTimesOfDay, kText };
  std::string reference;  ///< as `columns` names it: "3", "imu_gyr:2"
  std::string title;      ///< of the file, with its unit; "" if it has none
  Holds holds = Holds::kNumbers;
  bool zoned = false;  ///< of times: each says its zone
  /// Of dates, how they were read, and whether they could be read no other way.
  DateOrder date_order = DateOrder::kYearFirst;
  bool order_told = true;
  /// N, E, S or W that stands behind each number, or is the text; '?' where several
  /// do.
  char side = '\0';
  /// NaN where nothing or text stands. Dates and days are seconds since 1970, times of
  /// day seconds, as written if they say no zone, else UTC.
  std::vector<double> values;
};

/// The numbers of a file whose meaning nobody has declared.
struct FileColumns {
  const FileFormat* format = nullptr;  ///< columns, npy or mat
  std::vector<FileColumn> columns;
  std::size_t rows = 0;
  RowWord row_word = {};  ///< of a text with other rows between these
  int skip_lines = 0;     ///< before the first row of numbers
  std::string delimiter;  ///< as the key `delimiter` has it; "": auto
  bool cut_tail = false;  ///< the last line was cut off
  long text_rows = 0;     ///< rows of text between or behind those of numbers
  /// Numbers that stand for no reading, NaN among the columns' values.
  std::vector<double> bad_values = {};
  bool complete = true;  ///< false: a long file, of which this is the start
  std::map<std::string, double> scalars;  ///< variables of one number
  /// One clause each: what is odd about the file and what was done about it.
  std::vector<std::string> remarks;
};

/// Numbers kept of one file.
inline constexpr std::size_t kMostProbedNumbers = 20'000'000;

/// Of a delimited text, plain or gzip, with or without titles. Passed over are
/// lines before the numbers begin (`sep=,`, notes, a first line that was cut
/// off), first rows that hold nothing but zeros beside a count, and rows of text
/// further down. Dates and times of day count as numbers; a column of other text
/// may stand beside more columns of numbers. Nothing if fewer than
/// three rows of numbers of equal length are found. Throws InputError as TextLines does.
std::optional<FileColumns> ReadTextColumns(const std::string& path);
/// The same of the first `most_lines` lines.
std::optional<FileColumns> ReadTextBeginning(const std::string& path,
                                             long most_lines);

/// Of a text in which rows of several sensors stand between each other, each told by
/// a word in one of the first columns ("ACCE;0.034;...", "12.3,gyroscope,..."): a
/// table for each word that at least three rows have. Titles stand in comments
/// behind the word, above all rows, or in ArduPilot's FMT rows. Empty of other
/// texts. Throws InputError as TextLines does.
std::vector<FileColumns> ReadTypedColumns(const std::string& path);

/// ReadTypedColumns, else ReadTextColumns.
std::vector<FileColumns> ReadTextTables(const std::string& path);

/// Of the NumPy arrays in a folder, not below it: those with as many rows as
/// the longest. References and titles name them by the folder, "gyro/value:1".
/// Nothing if there are none.
std::optional<FileColumns> ReadNpyColumns(const std::string& folder);

/// Of a MATLAB file: the variables with as many rows as the longest, and those
/// of one number. Throws InputError if it is none or damaged.
FileColumns ReadMatColumns(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FILE_COLUMNS_H_
