#include "io/text_format.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/rtklib_pos.h"

namespace hindsight {
namespace {

std::int64_t TicksPerSecond(double seconds_per_tick) {
  return std::llround(1.0 / seconds_per_tick);
}

std::vector<ColumnMapping> Numbered(
    const std::vector<std::pair<const char*, const char*>>& titles) {
  std::vector<ColumnMapping> columns;
  for (const auto& [quantity, unit] : titles) {
    ColumnMapping mapping;
    mapping.quantity = quantity;
    mapping.column = static_cast<int>(columns.size());
    mapping.unit = unit;
    columns.push_back(mapping);
  }
  return columns;
}

/// KF-GINS's three text files, told apart by what the stream is.
std::vector<ColumnMapping> KfGinsColumns(const std::vector<FieldName>& fields) {
  if (&fields == &ImuFields()) {
    return Numbered({{"t", "s"},
                     {"dtheta_x", "rad"},
                     {"dtheta_y", "rad"},
                     {"dtheta_z", "rad"},
                     {"dvel_x", "m/s"},
                     {"dvel_y", "m/s"},
                     {"dvel_z", "m/s"}});
  }
  if (&fields == &TruthFields()) {
    std::vector<ColumnMapping> columns = Numbered({{"t", "s"},
                                                   {"lat", "deg"},
                                                   {"lon", "deg"},
                                                   {"h", "m"},
                                                   {"v_n", "m/s"},
                                                   {"v_e", "m/s"},
                                                   {"v_d", "m/s"},
                                                   {"roll", "deg"},
                                                   {"pitch", "deg"},
                                                   {"heading", "deg"}});
    // The week stands first; the other files of a set do not have it.
    for (ColumnMapping& mapping : columns) ++mapping.column;
    return columns;
  }
  std::vector<ColumnMapping> columns = Numbered({{"t", "s"},
                                                 {"lat", "deg"},
                                                 {"lon", "deg"},
                                                 {"h", "m"},
                                                 {"sigma_n", "m"},
                                                 {"sigma_e", "m"},
                                                 {"sigma_d", "m"}});
  columns.push_back({"sigma_h", 6, "", "m", 1.0});
  return columns;
}

struct Header {
  std::vector<std::string_view> titles;
  long line = 0;
};

class LayoutBuilder {
 public:
  LayoutBuilder(const std::string& path, const TextFormat& format,
                const std::vector<FieldName>& fields, const Header& header)
      : path_(path), format_(format), fields_(fields), header_(header) {
    layout_.clock = TableLayout::Clock::kNone;
    for (const FieldName& field : fields) {
      layout_.fields.push_back({field.name, -1, 1.0});
    }
  }

  void Add(const ColumnMapping& mapping) {
    int column = mapping.column;
    std::string unit = mapping.unit;
    if (column < 0) {
      const auto [found, header_unit] = FindTitle(mapping);
      column = found;
      if (unit.empty()) unit = header_unit;
    }
    if (mapping.quantity == "t" || mapping.quantity == "week") {
      AddTime(mapping.quantity, column, unit);
      return;
    }
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (mapping.quantity != fields_[i].name) continue;
      layout_.fields[i].column = column;
      layout_.fields[i].factor =
          mapping.scale * Factor(mapping, unit, fields_[i].quantity);
    }
  }

  TableLayout Finish() {
    if (format_.ignore_time) {
      layout_.clock = TableLayout::Clock::kNone;
    } else if (time_column_ < 0) {
      Fail("no column t with the time");
    } else if (week_column_ >= 0 && time_column_ != week_column_ + 1) {
      Fail("the seconds of week must stand right of the week");
    }
    return layout_;
  }

  [[noreturn]] void Fail(const std::string& message) const {
    if (header_.line > 0) throw InputError(path_, header_.line, message);
    throw InputError(format_.config_path, format_.config_line, message);
  }

 private:
  std::pair<int, std::string> FindTitle(const ColumnMapping& mapping) const {
    for (std::size_t i = 0; i < header_.titles.size(); ++i) {
      const auto [title, unit] = SplitTitle(header_.titles[i]);
      if (title == mapping.title) return {static_cast<int>(i), unit};
    }
    Fail("no column '" + mapping.title + "' in the header");
  }

  double Factor(const ColumnMapping& mapping, const std::string& unit,
                Quantity quantity) const {
    const auto factor = UnitFactor(unit, quantity);
    if (!factor) {
      Fail("column " + mapping.quantity +
           (unit.empty() ? " has no unit" : " has the unit '" + unit + "'") +
           "; expected one of " + UnitExamples(quantity));
    }
    return *factor;
  }

  void AddTime(const std::string& quantity, int column,
               const std::string& unit) {
    if (quantity == "week") {
      week_column_ = column;
      layout_.clock = TableLayout::Clock::kWeek;
      layout_.time_column = column;
      return;
    }
    ColumnMapping mapping;
    mapping.quantity = "t";
    time_column_ = column;
    const double factor = Factor(mapping, unit, Quantity::kTime);
    if (factor > 1.0 || (week_column_ >= 0 && factor < 1.0)) {
      Fail("column t has the unit '" + unit + "'; expected " +
           (week_column_ >= 0 ? "s" : "s, ms, us or ns"));
    }
    if (week_column_ >= 0) return;
    layout_.clock = TableLayout::Clock::kSeconds;
    layout_.time_column = column;
    layout_.ticks_per_second = TicksPerSecond(factor);
  }

  const std::string& path_;
  const TextFormat& format_;
  const std::vector<FieldName>& fields_;
  const Header& header_;
  TableLayout layout_;
  int time_column_ = -1;
  int week_column_ = -1;
};

/// The columns of an own CSV file whose titles name one of `fields`.
std::vector<ColumnMapping> TitledColumns(const std::string& path,
                                         const Header& header,
                                         const std::vector<FieldName>& fields) {
  std::vector<ColumnMapping> columns;
  for (std::size_t i = 0; i < header.titles.size(); ++i) {
    const auto [title, unit] = SplitTitle(header.titles[i]);
    const bool known =
        title == "t" || title == "week" ||
        std::any_of(fields.begin(), fields.end(), [&](const FieldName& field) {
          return title == field.name;
        });
    if (!known) continue;
    for (const ColumnMapping& other : columns) {
      if (other.quantity == title) {
        throw InputError(path, header.line,
                         "column " + title + " stands twice");
      }
    }
    ColumnMapping mapping;
    mapping.quantity = title;
    mapping.column = static_cast<int>(i);
    mapping.unit = title == "week" ? "1" : unit;
    // The week must be known before its seconds.
    columns.insert(title == "week" ? columns.begin() : columns.end(), mapping);
  }
  return columns;
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

}  // namespace

const std::vector<FieldName>& ImuFields() {
  static const std::vector<FieldName> kFields = {
      {"gyro_x", Quantity::kAngularRate},
      {"gyro_y", Quantity::kAngularRate},
      {"gyro_z", Quantity::kAngularRate},
      {"accel_x", Quantity::kAcceleration},
      {"accel_y", Quantity::kAcceleration},
      {"accel_z", Quantity::kAcceleration},
      {"dtheta_x", Quantity::kAngle},
      {"dtheta_y", Quantity::kAngle},
      {"dtheta_z", Quantity::kAngle},
      {"dvel_x", Quantity::kSpeed},
      {"dvel_y", Quantity::kSpeed},
      {"dvel_z", Quantity::kSpeed},
  };
  return kFields;
}

const std::vector<FieldName>& PositionFields() {
  static const std::vector<FieldName> kFields = {
      {"lat", Quantity::kAngle},      {"lon", Quantity::kAngle},
      {"h", Quantity::kLength},       {"sigma_n", Quantity::kLength},
      {"sigma_e", Quantity::kLength}, {"sigma_d", Quantity::kLength},
      {"sd_ne", Quantity::kLength},   {"sd_ed", Quantity::kLength},
      {"sd_dn", Quantity::kLength},   {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& VelocityFields() {
  static const std::vector<FieldName> kFields = {
      {"v_n", Quantity::kSpeed},       {"v_e", Quantity::kSpeed},
      {"v_d", Quantity::kSpeed},       {"sigma_v_n", Quantity::kSpeed},
      {"sigma_v_e", Quantity::kSpeed}, {"sigma_v_d", Quantity::kSpeed},
      {"sd_v_ne", Quantity::kSpeed},   {"sd_v_ed", Quantity::kSpeed},
      {"sd_v_dn", Quantity::kSpeed},   {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& HeightFields() {
  static const std::vector<FieldName> kFields = {
      {"h", Quantity::kLength},
      {"sigma_h", Quantity::kLength},
      {"quality", Quantity::kRatio},
  };
  return kFields;
}

const std::vector<FieldName>& TruthFields() {
  static const std::vector<FieldName> kFields = {
      {"lat", Quantity::kAngle},     {"lon", Quantity::kAngle},
      {"h", Quantity::kLength},      {"v_n", Quantity::kSpeed},
      {"v_e", Quantity::kSpeed},     {"v_d", Quantity::kSpeed},
      {"roll", Quantity::kAngle},    {"pitch", Quantity::kAngle},
      {"heading", Quantity::kAngle},
  };
  return kFields;
}

const char* FormatName(TextFormat::Kind kind) {
  switch (kind) {
    case TextFormat::Kind::kCsv:
      return "csv";
    case TextFormat::Kind::kColumns:
      return "columns";
    case TextFormat::Kind::kKfGins:
      return "kf_gins";
    case TextFormat::Kind::kRtklibPos:
      return "rtklib_pos";
  }
  return "";
}

std::pair<std::string, std::string> SplitTitle(std::string_view title) {
  const std::string_view text = Trim(title);
  const std::size_t open = text.find('[');
  if (open == text.npos || !text.ends_with(']')) return {std::string(text), ""};
  return {std::string(Trim(text.substr(0, open))),
          std::string(text.substr(open + 1, text.size() - open - 2))};
}

OpenedTable OpenTable(const std::string& path, const TextFormat& format,
                      const std::vector<FieldName>& fields,
                      TextTable::Options options) {
  OpenedTable opened;
  opened.lines = std::make_unique<TextLines>(path);
  std::string_view skipped;
  for (int i = 0; i < format.skip_lines; ++i) opened.lines->Next(&skipped);
  if (format.kind == TextFormat::Kind::kRtklibPos) {
    return OpenPos(path, fields, options, std::move(opened));
  }
  std::vector<ColumnMapping> columns = format.columns;
  if (format.kind == TextFormat::Kind::kKfGins) columns = KfGinsColumns(fields);
  const bool has_header =
      format.kind == TextFormat::Kind::kCsv ||
      std::any_of(columns.begin(), columns.end(),
                  [](const ColumnMapping& c) { return c.column < 0; });
  std::string row;
  if (!NextData(opened.lines.get(), &row)) NoRows(path);
  char delimiter = format.delimiter;
  if (format.kind == TextFormat::Kind::kCsv) delimiter = ',';
  if (delimiter == '\0') delimiter = GuessDelimiter(row);
  Header header;
  std::string header_text;
  if (has_header) {
    header_text.swap(row);
    header = {SplitLine(header_text, delimiter), opened.lines->number()};
    if (format.kind == TextFormat::Kind::kCsv) {
      columns = TitledColumns(path, header, fields);
    }
    if (!NextData(opened.lines.get(), &row)) NoRows(path);
  }
  LayoutBuilder builder(path, format, fields, header);
  for (const ColumnMapping& mapping : columns) builder.Add(mapping);
  TableLayout layout = builder.Finish();
  layout.delimiter = delimiter;
  if (has_header) layout.column_count = static_cast<int>(header.titles.size());
  opened.dated = layout.clock == TableLayout::Clock::kWeek;
  opened.table = std::make_unique<TextTable>(
      opened.lines.get(), std::move(layout), options, std::move(row));
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
    if (format.kind == TextFormat::Kind::kColumns) {
      throw InputError(format.config_path, format.config_line, message);
    }
    throw InputError(
        opened.lines->path(), 0,
        message + "; expected by the format " + FormatName(format.kind));
  }
}

}  // namespace hindsight
