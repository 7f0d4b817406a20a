#include "io/read/text_format.h"

#include <algorithm>

#include "base/error.h"
#include "io/read/array_rows.h"
#include "io/read/nmea.h"
#include "io/read/oxts.h"
#include "io/read/preset_columns.h"
#include "io/read/rosbag.h"
#include "io/read/rtklib_pos.h"
#include "io/read/text_layout.h"

namespace hindsight {
namespace {

std::size_t Index(TextFormat::Kind kind) {
  return static_cast<std::size_t>(kind);
}

bool NextData(TextLines* lines, std::string* line) {
  std::string_view view;
  while (lines->Next(&view)) {
    if (IsComment(view)) continue;
    *line = view;
    return true;
  }
  return false;
}

[[noreturn]] void NoRows(const std::string& path) {
  throw InputError(path, 0, "the file holds no rows of data");
}

OpenedTable OpenPos(const std::string& path,
                    const std::vector<FieldName>& fields,
                    TextTable::Options options, OpenedTable opened) {
  std::string header;
  std::string row;
  long header_line = 0;
  std::string_view view;
  while (row.empty() && opened.lines->Next(&view)) {
    if (view.starts_with('%')) {
      header = view;
      header_line = opened.lines->number();
    } else if (!IsComment(view)) {
      row = view;
    }
  }
  if (row.empty()) NoRows(path);
  TableLayout layout = RtklibPosLayout(path, header_line, header, row, fields);
  opened.dated = true;
  opened.table = std::make_unique<TextTable>(
      opened.lines.get(), std::move(layout), options, std::move(row));
  return opened;
}

OpenedTable OpenText(const std::string& path, const TextFormat& format,
                     const std::vector<FieldName>& fields,
                     TextTable::Options options, OpenedTable opened) {
  std::vector<ColumnMapping> columns = format.columns;
  if (!TakesColumns(format.kind)) columns = PresetColumns(format.kind, fields);
  if (columns.empty() && format.kind != TextFormat::Kind::kCsv) {
    throw InputError(format.config_path, format.config_line,
                     "the format " + FormatNames()[Index(format.kind)] +
                         " holds no such stream");
  }
  const bool has_header =
      format.kind == TextFormat::Kind::kCsv ||
      std::any_of(columns.begin(), columns.end(),
                  [](const ColumnMapping& c) { return c.column < 0; });
  std::string row;
  if (!NextData(opened.lines.get(), &row)) NoRows(path);
  char delimiter = format.delimiter;
  if (format.kind == TextFormat::Kind::kCsv) delimiter = ',';
  if (delimiter == '\0') delimiter = GuessDelimiter(row);
  TableHeader header;
  std::string header_text;
  if (has_header) {
    header_text.swap(row);
    header = {SplitLine(header_text, delimiter), opened.lines->number()};
    if (format.kind == TextFormat::Kind::kCsv) {
      columns = TitledColumns(path, header, fields);
    }
    if (!NextData(opened.lines.get(), &row)) NoRows(path);
  }
  TableLayout layout = BuildLayout(path, format, fields, columns, header);
  layout.delimiter = delimiter;
  if (has_header) layout.column_count = static_cast<int>(header.titles.size());
  opened.dated = layout.clock == TableLayout::Clock::kWeek ||
                 layout.clock == TableLayout::Clock::kIso ||
                 layout.clock == TableLayout::Clock::kIsoUtc;
  opened.table = std::make_unique<TextTable>(
      opened.lines.get(), std::move(layout), options, std::move(row));
  return opened;
}

}  // namespace

const std::vector<std::string>& FormatNames() {
  static const std::vector<std::string> kNames = {
      "csv",  "columns",        "kf_gins", "rtklib_pos", "euroc",
      "nclt", "control_points", "oxts",    "nmea",       "npy",
      "mat",  "rosbag"};
  return kNames;
}

bool TakesColumns(TextFormat::Kind kind) {
  return kind == TextFormat::Kind::kColumns || kind == TextFormat::Kind::kNpy ||
         kind == TextFormat::Kind::kMat;
}

namespace {

OpenedTable OpenFile(const std::string& path, const TextFormat& format,
                     const std::vector<FieldName>& fields,
                     TextTable::Options options) {
  OpenedTable opened;
  const auto take = [&](RowBuffer rows) {
    opened.table = std::make_unique<RowBuffer>(std::move(rows));
    return std::move(opened);
  };
  switch (format.kind) {
    case TextFormat::Kind::kNpy:
    case TextFormat::Kind::kMat:
      opened.table =
          OpenArrays(path, format, fields, options.allow_absent, &opened.dated);
      return opened;
    case TextFormat::Kind::kOxts:
      opened.dated = true;
      return take(ReadOxts(path, fields));
    case TextFormat::Kind::kRosbag:
      opened.dated = true;
      return take(ReadRosbag(path, format.topic, fields));
    default:
      break;
  }
  opened.lines = std::make_unique<TextLines>(path);
  std::string_view skipped;
  for (int i = 0; i < format.skip_lines; ++i) {
    if (!opened.lines->Next(&skipped)) NoRows(path);
  }
  if (format.kind == TextFormat::Kind::kNmea) {
    return take(ReadNmea(opened.lines.get(), fields, options, &opened.dated));
  }
  if (format.kind == TextFormat::Kind::kRtklibPos) {
    return OpenPos(path, fields, options, std::move(opened));
  }
  return OpenText(path, format, fields, options, std::move(opened));
}

}  // namespace

OpenedTable OpenTable(const std::string& path, const TextFormat& format,
                      const std::vector<FieldName>& fields,
                      TextTable::Options options) {
  OpenedTable opened = OpenFile(path, format, fields, options);
  opened.table =
      WithConstants(std::move(opened.table), format.constants, fields);
  return opened;
}

void RequireFields(const OpenedTable& opened, const TextFormat& format,
                   const std::vector<FieldName>& fields, std::size_t first,
                   std::size_t last) {
  for (std::size_t i = first; i <= last; ++i) {
    if (opened.table->Has(i)) continue;
    const std::string message = std::string("no column ") + fields[i].name +
                                ", in " + SiUnit(fields[i].quantity) +
                                " or a like unit";
    if (TakesColumns(format.kind)) {
      throw InputError(format.config_path, format.config_line, message);
    }
    throw InputError(opened.table->path(), 0,
                     message + "; expected by the format " +
                         FormatNames()[Index(format.kind)]);
  }
}

}  // namespace hindsight
