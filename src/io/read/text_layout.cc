#include "io/read/text_layout.h"

#include <cmath>
#include <optional>

#include "base/error.h"

namespace hindsight {
namespace {

std::int64_t TicksPerSecond(double seconds_per_tick) {
  return std::llround(1.0 / seconds_per_tick);
}

class LayoutBuilder {
 public:
  LayoutBuilder(const std::string& path, const TextFormat& format,
                const std::vector<FieldName>& fields, const TableHeader& header)
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
    if (mapping.quantity == "date") {
      AddDate(column, unit);
      return;
    }
    if (mapping.quantity == kRestOfSecond) {
      AddRest(column, unit);
      return;
    }
    if (mapping.quantity == "t" || mapping.quantity == "week") {
      if (mapping.scale != 1.0) {
        Fail("column " + mapping.quantity + " takes no scale; expected a unit");
      }
      AddTime(mapping.quantity, column, unit);
      return;
    }
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (mapping.quantity != fields_[i].name) continue;
      layout_.fields[i].column = column;
      TableLayout::Field& field = layout_.fields[i];
      field.is_place = mapping.quantity == "lat" || mapping.quantity == "lon";
      field.has_minutes = field.is_place && unit == kDegreesMinutesUnit;
      field.factor =
          mapping.scale * Factor(mapping, field.has_minutes ? "deg" : unit,
                                 fields_[i].quantity);
    }
  }

  TableLayout Finish() {
    if (format_.ignore_time) {
      layout_.clock = TableLayout::Clock::kNone;
    } else if (time_column_ < 0) {
      Fail(format_.kind == &CsvFormat()
               ? "no column t with the time; `format: columns` reads titles of "
                 "any name, and rows without a time by `time: {rate: ...}`"
               : "no column t with the time; expected t under `columns`, or "
                 "`time: {rate: ...}` for rows that are counted");
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
    std::optional<std::pair<int, std::string>> found;
    for (std::size_t i = 0; i < header_.titles.size(); ++i) {
      const auto [title, unit] = SplitTitle(header_.titles[i]);
      if (title != mapping.title) continue;
      if (found) Fail("column '" + title + "' stands twice in the header");
      found.emplace(static_cast<int>(i), unit);
    }
    if (!found) Fail("no column '" + mapping.title + "' in the header");
    return *found;
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

  void AddDate(int column, const std::string& unit) {
    if (week_column_ >= 0) Fail("column date does not go with week");
    if (unit != "UTC" && unit != "GPST") {
      Fail("column date has the unit '" + unit + "'; expected UTC or GPST");
    }
    layout_.clock = unit == "UTC" ? TableLayout::Clock::kDateUtc
                                  : TableLayout::Clock::kDate;
    layout_.time_column = column;
  }

  void AddRest(int column, const std::string& unit) {
    if (layout_.clock != TableLayout::Clock::kSeconds ||
        layout_.ticks_per_second != 1 || week_column_ >= 0) {
      Fail("column t_rest goes with a column t of whole seconds");
    }
    const auto factor = UnitFactor(unit, Quantity::kTime);
    if (!factor || *factor >= 1.0) {
      Fail("column t_rest has the unit '" + unit + "'; expected ns, us or ms");
    }
    layout_.clock = TableLayout::Clock::kSplit;
    layout_.clock_column = column;
    layout_.rest_unit = *factor;
  }

  void AddTime(const std::string& quantity, int column,
               const std::string& unit) {
    if (quantity == "week") {
      week_column_ = column;
      layout_.clock = TableLayout::Clock::kWeek;
      layout_.time_column = column;
      return;
    }
    time_column_ = column;
    if (layout_.clock == TableLayout::Clock::kDate ||
        layout_.clock == TableLayout::Clock::kDateUtc) {
      layout_.clock_column = column;
      return;
    }
    if (week_column_ < 0 && (unit == "UTC" || unit == "GPST")) {
      layout_.clock = unit == "UTC" ? TableLayout::Clock::kIsoUtc
                                    : TableLayout::Clock::kIso;
      layout_.time_column = column;
      return;
    }
    if (const auto first_day = FirstDayOf(unit);
        first_day && week_column_ < 0) {
      layout_.clock = TableLayout::Clock::kDays;
      layout_.time_column = column;
      layout_.first_day = *first_day;
      return;
    }
    if (week_column_ < 0 && unit == kTimeOfDayUnit) {
      layout_.clock = TableLayout::Clock::kOfDay;
      layout_.time_column = column;
      return;
    }
    ColumnMapping mapping;
    mapping.quantity = "t";
    const double factor = Factor(mapping, unit, Quantity::kTime);
    if (week_column_ >= 0 && factor != 1.0) {
      Fail("column t has the unit '" + unit + "'; expected s");
    }
    if (week_column_ >= 0) return;
    if (factor > 1.0) {
      layout_.clock = TableLayout::Clock::kMinutes;
      layout_.time_column = column;
      layout_.long_unit = factor;
      return;
    }
    layout_.clock = TableLayout::Clock::kSeconds;
    layout_.time_column = column;
    layout_.ticks_per_second = TicksPerSecond(factor);
  }

  const std::string& path_;
  const TextFormat& format_;
  const std::vector<FieldName>& fields_;
  const TableHeader& header_;
  TableLayout layout_;
  int time_column_ = -1;
  int week_column_ = -1;
};

}  // namespace

std::optional<double> FirstDayOf(std::string_view unit) {
  if (unit == "datenum") return 719529.0;
  if (unit == "excel") return 25569.0;
  return std::nullopt;
}

double FromDegreesMinutes(double ddmm) {
  constexpr double kMinutes = 60.0;
  const double degrees = std::trunc(ddmm / 100.0);
  return degrees + (ddmm - 100.0 * degrees) / kMinutes;
}

std::optional<double> ParsePlace(std::string_view text) {
  constexpr std::string_view kLetters = "NnEeSsWw";
  if (text.size() < 2) return std::nullopt;
  const std::size_t letter = kLetters.find(text.back());
  if (letter == kLetters.npos) return std::nullopt;
  text.remove_suffix(1);
  auto value = ParseNumber(Trim(text));
  if (value && letter >= 4) value = -*value;
  return value;
}

std::pair<std::string, std::string> SplitTitle(std::string_view title) {
  const std::string_view text = Trim(title);
  const std::size_t open = text.find('[');
  if (open == text.npos || !text.ends_with(']')) return {std::string(text), ""};
  return {std::string(Trim(text.substr(0, open))),
          std::string(text.substr(open + 1, text.size() - open - 2))};
}

std::vector<ColumnMapping> TitledColumns(const std::string& path,
                                         const TableHeader& header,
                                         const std::vector<FieldName>& fields) {
  std::vector<ColumnMapping> columns;
  for (std::size_t i = 0; i < header.titles.size(); ++i) {
    const auto [title, unit] = SplitTitle(header.titles[i]);
    const bool known =
        title == "t" || title == "week" || FieldIndex(fields, title);
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

TableLayout BuildLayout(const std::string& path, const TextFormat& format,
                        const std::vector<FieldName>& fields,
                        const std::vector<ColumnMapping>& columns,
                        const TableHeader& header) {
  LayoutBuilder builder(path, format, fields, header);
  for (const ColumnMapping& mapping : columns) builder.Add(mapping);
  return builder.Finish();
}

}  // namespace hindsight
