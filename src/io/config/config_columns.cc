#include "io/config/config_columns.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>

#include "base/nearest_word.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

Quantity QuantityOf(ConfigMap* columns, const std::string& name,
                    const std::vector<FieldName>& fields) {
  if (name == "t" || name == kRestOfSecond) return Quantity::kTime;
  if (name == "week" || name == "date") return Quantity::kRatio;
  std::vector<std::string> names = {"t", std::string(kRestOfSecond), "week",
                                    "date"};
  for (const FieldName& field : fields) {
    if (name == field.name) return field.quantity;
    names.emplace_back(field.name);
  }
  std::string expected;
  for (const std::string& known : names) {
    expected += (expected.empty() ? "one of " : ", ") + known;
  }
  if (const std::string near = NearestWord(name, names); !near.empty()) {
    expected = "perhaps '" + near + "', or " + expected;
  }
  columns->Fail(name, "is not a quantity of this stream; expected " + expected);
}

/// Of a file.
constexpr int kMostColumns = 100000;

/// A column is a number from 1, or else a title; false for a number beyond the
/// last column that there can be.
bool SetColumn(const std::string& text, ColumnMapping* mapping) {
  int number = 0;
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = result.ptr == text.data() + text.size() && !text.empty();
  if (whole && result.ec == std::errc::result_out_of_range) return false;
  if (whole && result.ec == std::errc() && number >= 1) {
    mapping->column = number - 1;
  } else {
    mapping->title = text;
  }
  return number <= kMostColumns;
}

std::string TooManyColumns() {
  return "expected a column of 1 to " + std::to_string(kMostColumns);
}

ColumnMapping ReadColumn(ConfigMap* columns, const std::string& name,
                         Quantity quantity) {
  ColumnMapping mapping;
  mapping.quantity = name;
  if (columns->IsMap(name)) {
    ConfigMap entry = columns->Map(name);
    if (!SetColumn(entry.Text("column"), &mapping)) {
      entry.Fail("column", TooManyColumns());
    }
    mapping.unit = entry.Text("unit", "");
    const std::string scale = entry.Text("scale", "1");
    const auto number = ParseNumber(scale);
    if (!number || *number == 0.0) {
      entry.Fail("scale", "'" + scale + "' is not a number other than zero");
    }
    mapping.scale = *number;
    entry.Finish();
  } else {
    auto [title, unit] = SplitTitle(columns->Text(name));
    if (title.starts_with('-')) {
      mapping.scale = -1.0;
      title.erase(0, 1);
    }
    if (!SetColumn(title, &mapping)) columns->Fail(name, TooManyColumns());
    mapping.unit = unit;
  }
  // Dates, whose unit is their scale; a time of day beside one has none.
  const bool date = (name == "t" || name == "date") &&
                    (mapping.unit == "UTC" || mapping.unit == "GPST" ||
                     (name == "t" && (mapping.unit == kTimeOfDayUnit ||
                                      FirstDayOf(mapping.unit))));
  const bool minutes =
      (name == "lat" || name == "lon") && mapping.unit == kDegreesMinutesUnit;
  const bool of_day =
      name == "t" && columns->Has("date") && mapping.unit.empty();
  if (name == "week" || date || of_day || minutes) return mapping;
  if (name == "date") {
    columns->Fail(name, "expected COLUMN [UTC] or COLUMN [GPST]");
  }
  if (mapping.unit.empty() && mapping.column >= 0) {
    columns->Fail(name, std::string("has no unit; expected COLUMN [UNIT] with "
                                    "one of ") +
                            UnitExamples(quantity));
  } else if (!mapping.unit.empty() && !UnitFactor(mapping.unit, quantity)) {
    columns->Fail(name, "has the unit '" + mapping.unit +
                            "'; expected one of " + UnitExamples(quantity));
  }
  return mapping;
}

/// `{constant: VALUE}` in place of a column; nothing if it is a column.
std::optional<ConstantColumn> ReadConstant(
    ConfigMap* columns, const std::string& name, Quantity quantity,
    const std::vector<FieldName>& fields) {
  if (!columns->IsMap(name)) return std::nullopt;
  ConfigMap entry = columns->Map(name);
  if (!entry.Has("constant")) return std::nullopt;
  if (name == "t" || name == kRestOfSecond || name == "week" ||
      name == "date") {
    entry.Fail("constant", "time does not stand still; expected a column");
  }
  if (&fields == &ImuFields()) {
    entry.Fail("constant",
               "what every row repeats is no inertial reading; expected a "
               "column");
  }
  for (const char* key : {"column", "unit", "scale"}) {
    if (entry.Has(key))
      entry.Fail("constant", std::string("does not go with ") + key);
  }
  const ConstantColumn constant = {name, entry.Number("constant", quantity)};
  entry.Finish();
  return constant;
}

}  // namespace

void ReadColumns(ConfigMap* map, const std::vector<FieldName>& fields,
                 TextFormat* format) {
  std::vector<ColumnMapping>& mappings = format->columns;
  ConfigMap columns = map->Map("columns");
  for (const std::string& name : columns.Keys()) {
    const Quantity quantity = QuantityOf(&columns, name, fields);
    if (const auto constant = ReadConstant(&columns, name, quantity, fields)) {
      format->constants.push_back(*constant);
      continue;
    }
    const ColumnMapping mapping = ReadColumn(&columns, name, quantity);
    const bool before_t = name == "week" || name == "date";
    mappings.insert(before_t ? mappings.begin() : mappings.end(), mapping);
  }
  std::stable_partition(mappings.begin(), mappings.end(),
                        [](const ColumnMapping& mapping) {
                          return mapping.quantity != kRestOfSecond;
                        });
}

}  // namespace hindsight
