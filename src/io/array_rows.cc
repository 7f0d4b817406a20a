#include "io/array_rows.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "io/numeric_array.h"

namespace hindsight {
namespace {

/// One column of one array.
struct Column {
  const NumericArray* array = nullptr;
  std::size_t index = 0;
  double factor = 1.0;
};

class ArrayReader {
 public:
  ArrayReader(const std::string& path, const TextFormat& format)
      : path_(path), format_(format) {}

  Column Open(const ColumnMapping& mapping, Quantity quantity) {
    std::string name = mapping.title;
    int number = mapping.column + 1;
    if (const std::size_t colon = name.rfind(':'); colon != name.npos) {
      const char* end = name.data() + name.size();
      const auto result = std::from_chars(name.data() + colon + 1, end, number);
      if (result.ec != std::errc() || result.ptr != end || number < 1) {
        Fail(mapping, "expected a column from 1 behind ':'");
      }
      name.resize(colon);
    } else if (mapping.column < 0) {
      number = 1;
    }
    const auto factor = UnitFactor(mapping.unit, quantity);
    if (!factor) {
      Fail(mapping, std::string("has no unit; expected one of ") +
                        UnitExamples(quantity));
    }
    Column column = {&Array(name), static_cast<std::size_t>(number - 1),
                     mapping.scale * *factor};
    if (column.index >= column.array->columns) {
      Fail(mapping, "there is no column " + std::to_string(number) + " of " +
                        std::to_string(column.array->columns));
    }
    if (arrays_.begin()->second.rows != column.array->rows) {
      Fail(mapping, "has " + std::to_string(column.array->rows) + " rows and " +
                        arrays_.begin()->first + " " +
                        std::to_string(arrays_.begin()->second.rows));
    }
    return column;
  }

  std::size_t rows() const {
    return arrays_.empty() ? 0 : arrays_.begin()->second.rows;
  }

 private:
  const NumericArray& Array(const std::string& name) {
    const auto known = arrays_.find(name);
    if (known != arrays_.end()) return known->second;
    NumericArray array;
    if (format_.kind == TextFormat::Kind::kMat) {
      array = ReadMat(path_, name);
    } else if (name.empty()) {
      array = ReadNpy(path_);
    } else {
      array = ReadNpy((std::filesystem::path(path_) / name).string());
    }
    return arrays_.emplace(name, std::move(array)).first->second;
  }

  [[noreturn]] void Fail(const ColumnMapping& mapping,
                         const std::string& message) const {
    throw InputError(
        format_.config_path, format_.config_line,
        "columns." + mapping.quantity + " (" + path_ + "): " + message);
  }

  const std::string& path_;
  const TextFormat& format_;
  std::map<std::string, NumericArray> arrays_;
};

Stamp StampOf(const Column& column, std::size_t row, const std::string& path) {
  const NumericArray& array = *column.array;
  const std::size_t at = row * array.columns + column.index;
  const double t = array.values[at] * column.factor;
  if (!IsTime(t)) {
    throw InputError(path, static_cast<long>(row) + 1,
                     "the time is not a finite number of a usual size");
  }
  if (!array.integers.empty()) {
    const std::int64_t ticks = array.integers[at];
    const std::int64_t rate =
        std::max<std::int64_t>(1, std::llround(1.0 / std::abs(column.factor)));
    return {ticks / rate, static_cast<double>(ticks % rate) * column.factor};
  }
  const double whole = std::floor(t);
  return {static_cast<std::int64_t>(whole), t - whole};
}

std::int64_t WeekOf(const Column& column, std::size_t row,
                    const std::string& path) {
  const double week = column.array->at(row, column.index);
  if (!(week >= 0.0 && week <= kLastWeek) || week != std::floor(week)) {
    throw InputError(path, static_cast<long>(row) + 1, "there is no such week");
  }
  return static_cast<std::int64_t>(week);
}

}  // namespace

RowBuffer ReadArrays(const std::string& path, const TextFormat& format,
                     const std::vector<FieldName>& fields, bool allow_absent,
                     bool* dated) {
  ArrayReader reader(path, format);
  std::optional<Column> time;
  std::optional<Column> week;
  std::vector<std::pair<std::size_t, Column>> columns;
  for (const ColumnMapping& mapping : format.columns) {
    if (mapping.quantity == "t") {
      if (!format.ignore_time) time = reader.Open(mapping, Quantity::kTime);
      continue;
    }
    if (mapping.quantity == "week") {
      ColumnMapping plain = mapping;
      plain.unit = "1";
      week = reader.Open(plain, Quantity::kRatio);
      continue;
    }
    const auto field = FieldIndex(fields, mapping.quantity);
    if (!field) continue;
    columns.emplace_back(*field, reader.Open(mapping, fields[*field].quantity));
  }
  if (!time && !format.ignore_time) {
    throw InputError(format.config_path, format.config_line,
                     "no column t with the time; expected it, or time.rate");
  }
  *dated = week.has_value();
  RowBuffer rows(path, fields, allow_absent);
  rows.Reserve(reader.rows());
  for (const auto& [field, column] : columns) rows.Declare(field);
  for (std::size_t row = 0; row < reader.rows(); ++row) {
    Stamp stamp = time ? StampOf(*time, row, path) : Stamp{};
    if (week) {
      stamp.seconds += WeekOf(*week, row, path) * kWeekSeconds;
    }
    rows.Append(stamp, static_cast<long>(row) + 1);
    for (const auto& [field, column] : columns) {
      rows.Set(row, field, column.factor * column.array->at(row, column.index));
    }
  }
  if (rows.size() == 0) throw InputError(path, 0, "holds no rows of data");
  return rows;
}

}  // namespace hindsight
