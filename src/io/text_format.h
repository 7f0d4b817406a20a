#ifndef HINDSIGHT_IO_TEXT_FORMAT_H_
#define HINDSIGHT_IO_TEXT_FORMAT_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/text_table.h"
#include "io/units.h"

namespace hindsight {

/// A quantity that a stream may hold, by its name in files and configurations.
struct FieldName {
  const char* name;
  Quantity quantity;
};

/// Quantities of each kind of stream. sd_ne, sd_ed, sd_dn (and sd_v_ne, ...)
/// are covariances as signed square roots: sd_ne |sd_ne| = cov(n, e).
const std::vector<FieldName>& ImuFields();
const std::vector<FieldName>& PositionFields();
const std::vector<FieldName>& VelocityFields();
const std::vector<FieldName>& HeightFields();
const std::vector<FieldName>& TruthFields();

/// One entry of `columns:` in a configuration.
struct ColumnMapping {
  std::string quantity;  ///< a FieldName, or "t" or "week"
  int column = -1;       ///< from 0, or -1: found by `title`
  std::string title;     ///< in the header line, unit not included
  std::string unit;      ///< empty: the header line gives it
  double scale = 1.0;    ///< applied after the unit, sign included
};

/// How a text file is laid out.
struct TextFormat {
  enum class Kind {
    kCsv,        ///< io/csv_format.h
    kColumns,    ///< `columns` says it
    kKfGins,     ///< KF-GINS and OB_GINS text (FORMATS of that program)
    kRtklibPos,  ///< RTKLIB .pos, latitude/longitude/height in degrees
  };
  Kind kind = Kind::kCsv;
  char delimiter = '\0';  ///< '\0': guessed from the first line of data
  int skip_lines = 0;     ///< before everything else
  std::vector<ColumnMapping> columns;
  /// The file's stamps are not looked at.
  bool ignore_time = false;
  /// Where the format was declared, for messages.
  std::string config_path;
  long config_line = 0;
};

/// "csv", "columns", "kf_gins", "rtklib_pos".
const char* FormatName(TextFormat::Kind kind);

/// A table open for reading.
struct OpenedTable {
  std::unique_ptr<TextLines> lines;
  std::unique_ptr<TextTable> table;
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

#endif  // HINDSIGHT_IO_TEXT_FORMAT_H_
