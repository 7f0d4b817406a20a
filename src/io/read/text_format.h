#ifndef HINDSIGHT_IO_READ_TEXT_FORMAT_H_
#define HINDSIGHT_IO_READ_TEXT_FORMAT_H_

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/read/constant_columns.h"
#include "io/read/fields.h"
#include "io/read/row_source.h"
#include "io/read/row_word.h"
#include "io/read/text_table.h"

namespace hindsight {

struct FileFormat;
const FileFormat& CsvFormat();

/// One entry of `columns:` in a configuration.
struct ColumnMapping {
  std::string quantity;  ///< a FieldName, or "t" or "week"
  int column = -1;       ///< from 0, or -1: found by `title`
  /// In the header line, unit not included; of npy and mat:
  /// io/read/array_rows.h.
  std::string title;
  std::string unit;    ///< empty: the header line gives it
  double scale = 1.0;  ///< applied after the unit, sign included
};

/// What a configuration says of how a file is laid out.
struct TextFormat {
  const FileFormat* kind = &CsvFormat();
  char delimiter = '\0';  ///< '\0': guessed from the first line of data
  char decimal = '\0';    ///< '.', ',' or '\0': guessed likewise
  DateOrder date_order = DateOrder::kYearFirst;
  int skip_lines = 0;  ///< before everything else
  RowWord rows = {};   ///< lines that are the stream's; of `columns`
  /// Numbers that stand for no reading, as the file has them; of `columns`.
  std::vector<double> bad_values = {};
  std::vector<ColumnMapping> columns;     ///< if FileFormat::takes_columns
  std::vector<ConstantColumn> constants;  ///< besides `columns`
  /// Of FileFormat::keys, those that were given.
  std::map<std::string, std::string, std::less<>> values;
  /// The file's stamps are not looked at.
  bool ignore_time = false;
  /// Where the format was declared, for messages.
  std::string config_path;
  long config_line = 0;
};

/// What a column of times of day, hh:mm:ss.sss, has for a unit.
inline constexpr std::string_view kTimeOfDayUnit = "hms";
/// The column of what is left of a second, beside a column t of whole ones.
inline constexpr std::string_view kRestOfSecond = "t_rest";

/// What a column of degrees and minutes, "4807.038" as NMEA writes it, has for one.
inline constexpr std::string_view kDegreesMinutesUnit = "ddmm";

/// Of a unit of stamps that count days, "datenum" as MATLAB does and "excel" as
/// spreadsheets, what 1970-01-01 is in it [d]; nothing of another.
std::optional<double> FirstDayOf(std::string_view unit);

/// Degrees of "4807.038", in the sign of the whole.
double FromDegreesMinutes(double ddmm);

/// A number with N, E, S or W behind it, negative with the last two.
std::optional<double> ParsePlace(std::string_view text);

/// A table open for reading.
struct OpenedTable {
  std::unique_ptr<TextLines> lines;  ///< null for formats that are not text
  std::unique_ptr<RowSource> table;
  bool dated = false;  ///< stamps are GPS time since 1980-01-06
};

/// Opens `path` as `format`, with the quantities `fields` in that order; those
/// the file does not hold are absent (TextTable::Has). Throws InputError for a
/// header that does not fit the format, a unit that does not fit its column, or
/// a file without rows.
OpenedTable OpenTable(const std::string& path, const TextFormat& format,
                      const std::vector<FieldName>& fields,
                      TextTable::Options options);

/// Throws InputError if a field between `first` and `last` is not in the table.
void RequireFields(const OpenedTable& opened, const TextFormat& format,
                   const std::vector<FieldName>& fields, std::size_t first,
                   std::size_t last);

/// "gyro_x[deg/s]" as ("gyro_x", "deg/s"); the unit is empty if there is none.
std::pair<std::string, std::string> SplitTitle(std::string_view title);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_FORMAT_H_
