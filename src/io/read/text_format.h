#ifndef HINDSIGHT_IO_READ_TEXT_FORMAT_H_
#define HINDSIGHT_IO_READ_TEXT_FORMAT_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/read/constant_columns.h"
#include "io/read/fields.h"
#include "io/read/row_source.h"
#include "io/read/text_table.h"

namespace hindsight {

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

/// How a file is laid out.
struct TextFormat {
  enum class Kind {
    kCsv,            ///< docs/formats.md
    kColumns,        ///< `columns` says it
    kKfGins,         ///< KF-GINS and OB_GINS text, io/read/preset_columns.h
    kRtklibPos,      ///< RTKLIB .pos, latitude/longitude/height in degrees
    kEuroc,          ///< io/read/preset_columns.h
    kNclt,           ///< io/read/preset_columns.h
    kControlPoints,  ///< io/read/preset_columns.h
    kOxts,           ///< KITTI's folder, io/read/oxts.h
    kNmea,           ///< io/read/nmea.h
    kNpy,            ///< io/read/array_rows.h
    kMat,            ///< io/read/array_rows.h
    kRosbag,         ///< io/read/rosbag.h
  };
  Kind kind = Kind::kCsv;
  char delimiter = '\0';  ///< '\0': guessed from the first line of data
  int skip_lines = 0;     ///< before everything else
  std::vector<ColumnMapping> columns;
  std::vector<ConstantColumn> constants;  ///< besides `columns`
  std::string topic;  ///< of a bag; empty: the only one of a fitting type
  /// The file's stamps are not looked at.
  bool ignore_time = false;
  /// Where the format was declared, for messages.
  std::string config_path;
  long config_line = 0;
};

/// The names of the formats in configurations, in the order of Kind.
const std::vector<std::string>& FormatNames();

/// True if the configuration lists the columns of the format.
bool TakesColumns(TextFormat::Kind kind);

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
