#include "io/row_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hindsight {

RowBuffer::RowBuffer(std::string path, const std::vector<FieldName>& fields,
                     bool allow_absent)
    : path_(std::move(path)),
      fields_(fields),
      allow_absent_(allow_absent),
      has_(fields.size(), false),
      files_({path_}) {
  values_.assign(fields.size(), std::numeric_limits<double>::quiet_NaN());
}

bool RowBuffer::Declare(const std::string& field) {
  const auto i = FieldIndex(fields_, field);
  if (i) has_[*i] = true;
  return i.has_value();
}

void RowBuffer::Reserve(std::size_t rows) {
  places_.reserve(rows);
  data_.reserve(rows * has_.size());
}

void RowBuffer::Append(const Stamp& stamp, long line, const std::string& path) {
  if (!path.empty() && path != files_.back()) files_.push_back(path);
  places_.push_back(
      {stamp, line, path.empty() ? 0 : files_.size() - 1, places_.size()});
  data_.resize(data_.size() + has_.size(),
               std::numeric_limits<double>::quiet_NaN());
}

void RowBuffer::Set(const std::string& field, double value) {
  const auto i = FieldIndex(fields_, field);
  if (i) Set(places_.size() - 1, *i, value);
}

void RowBuffer::LeaveOut(const std::string& action, long count) {
  if (count > 0) left_out_.push_back({action, count});
}

long RowBuffer::Sort() {
  long behind = 0;
  Stamp latest;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (i > 0 && places_[i].stamp.Since(latest) < 0.0) {
      ++behind;
    } else {
      latest = places_[i].stamp;
    }
  }
  std::stable_sort(places_.begin(), places_.end(),
                   [](const Place& a, const Place& b) {
                     return a.stamp.Since(b.stamp) < 0.0;
                   });
  return behind;
}

bool RowBuffer::Next() {
  if (next_ == places_.size()) return false;
  const Place& place = places_[next_++];
  stamp_ = place.stamp;
  line_ = place.line;
  const std::size_t width = has_.size();
  for (std::size_t i = 0; i < width; ++i) {
    values_[i] = data_[place.row * width + i];
    if (!has_[i] || std::isfinite(values_[i])) continue;
    if (!allow_absent_ || !std::isnan(values_[i])) {
      Fail(std::string("the value of ") + fields_[i].name +
           " is not a finite number");
    }
  }
  return true;
}

const std::string& RowBuffer::row_path() const {
  return files_[next_ == 0 ? 0 : places_[next_ - 1].file];
}

RowBuffer Buffered(RowSource* rows, const std::vector<FieldName>& fields,
                   bool allow_absent) {
  RowBuffer buffer(rows->path(), fields, allow_absent);
  buffer.Reserve(rows->RowsHint());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (rows->Has(i)) buffer.Declare(i);
  }
  while (rows->Next()) {
    buffer.Append(rows->stamp(), rows->line());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      buffer.Set(buffer.size() - 1, i, rows->value(i));
    }
  }
  for (const LeftOut& left : rows->left_out()) {
    buffer.LeaveOut(left.action, left.count);
  }
  return buffer;
}

}  // namespace hindsight
