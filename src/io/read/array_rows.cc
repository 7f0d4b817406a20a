#include "io/read/array_rows.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/error.h"
#include "io/read/tick_clock.h"
#include "io/read/units.h"

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
  ArrayReader(const std::string& path, const TextFormat& format,
              ArrayReading read)
      : path_(path), format_(format), read_(read) {}

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
    if (first_.array == nullptr) {
      first_ = column;
      first_name_ = name;
    }
    if (first_.array->rows != column.array->rows) {
      Fail(mapping, "has " + std::to_string(column.array->rows) + " rows and " +
                        first_name_ + " " + std::to_string(first_.array->rows));
    }
    return column;
  }

  std::size_t rows() const {
    return first_.array == nullptr ? 0 : first_.array->rows;
  }

  [[noreturn]] void Fail(const ColumnMapping& mapping,
                         const std::string& message) const {
    throw InputError(
        format_.config_path, format_.config_line,
        "columns." + mapping.quantity + " (" + path_ + "): " + message);
  }

 private:
  const NumericArray& Array(const std::string& name) {
    const auto known = arrays_.find(name);
    if (known != arrays_.end()) return known->second;
    return arrays_.emplace(name, read_(path_, name)).first->second;
  }

  std::string path_;
  TextFormat format_;
  ArrayReading read_;
  std::map<std::string, NumericArray> arrays_;
  Column first_;  ///< has the number of rows that all have
  std::string first_name_;
};

class ArrayRows final : public RowSource {
 public:
  ArrayRows(const TableRequest& request, ArrayReading read)
      : reader_(request.path, request.format, read),
        path_(request.path),
        fields_(request.fields),
        allow_absent_(request.options.allow_absent),
        columns_(request.fields.size()) {
    const TextFormat& format = request.format;
    const std::vector<FieldName>& fields = request.fields;
    values_.assign(fields.size(), std::numeric_limits<double>::quiet_NaN());
    for (const ColumnMapping& mapping : format.columns) {
      if (mapping.quantity == "t") {
        if (!format.ignore_time) OpenTime(mapping);
      } else if (mapping.quantity == kRestOfSecond) {
        throw InputError(format.config_path, format.config_line,
                         "t_rest is a column of texts alone");
      } else if (mapping.quantity == "week") {
        ColumnMapping plain = mapping;
        plain.unit = "1";
        week_ = reader_.Open(plain, Quantity::kRatio);
      } else if (const auto field = FieldIndex(fields, mapping.quantity)) {
        columns_[*field] = reader_.Open(mapping, fields[*field].quantity);
      }
    }
    if (!time_ && !format.ignore_time) {
      throw InputError(format.config_path, format.config_line,
                       "no column t with the time; expected it, or time.rate");
    }
    if (reader_.rows() == 0)
      throw InputError(path_, 0, "holds no rows of data");
  }

  bool dated() const { return week_.has_value(); }

  bool Next() override {
    if (row_ == reader_.rows()) return false;
    const std::size_t row = row_++;
    line_ = static_cast<long>(row_);
    stamp_ = time_ ? StampAt(row) : Stamp{};
    if (week_) stamp_.seconds += WeekAt(row) * kWeekSeconds;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!columns_[i]) continue;
      values_[i] =
          columns_[i]->factor * columns_[i]->array->at(row, columns_[i]->index);
      if (std::isfinite(values_[i])) continue;
      if (allow_absent_ && std::isnan(values_[i])) continue;
      Fail(std::string("the value of ") + fields_[i].name +
           " is not a finite number");
    }
    return true;
  }
  bool Has(std::size_t field) const override {
    return columns_[field].has_value();
  }
  std::size_t RowsHint() const override { return reader_.rows(); }
  const std::string& path() const override { return path_; }

 private:
  void OpenTime(const ColumnMapping& mapping) {
    time_ = reader_.Open(mapping, Quantity::kTime);
    if (!TickClock::IsLength(time_->factor)) {
      reader_.Fail(mapping, "has a unit or scale of " +
                                FormatNumber(time_->factor) +
                                " s; expected between 1e-12 and 1e9");
    }
    if (time_->array->IsInteger()) ticks_.emplace(time_->factor);
  }

  Stamp StampAt(std::size_t row) const {
    const NumericArray& array = *time_->array;
    const double t = array.at(row, time_->index) * time_->factor;
    if (!IsTime(t)) {
      Fail("the time is not a finite number of a usual size");
    }
    if (ticks_) {
      const auto [negative, ticks] = array.IntegerAt(row, time_->index);
      return ticks_->At(negative, ticks);
    }
    const double whole = std::floor(t);
    return {static_cast<std::int64_t>(whole), t - whole};
  }

  std::int64_t WeekAt(std::size_t row) const {
    const double week = week_->array->at(row, week_->index);
    if (!(week >= 0.0 && week <= kLastWeek) || week != std::floor(week)) {
      Fail("there is no such week");
    }
    return static_cast<std::int64_t>(week);
  }

  ArrayReader reader_;
  std::string path_;
  const std::vector<FieldName>& fields_;
  bool allow_absent_;
  std::optional<Column> time_;
  std::optional<Column> week_;
  std::optional<TickClock> ticks_;  ///< of stamps that are whole numbers
  std::vector<std::optional<Column>> columns_;  ///< of each field
  std::size_t row_ = 0;
};

}  // namespace

OpenedTable OpenArrays(const TableRequest& request, ArrayReading read) {
  auto rows = std::make_unique<ArrayRows>(request, read);
  OpenedTable opened;
  opened.dated = rows->dated();
  opened.table = std::move(rows);
  return opened;
}

}  // namespace hindsight
