#include "io/read/row_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"

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

Stamp RowBuffer::StampIn(const PackedRow& row) {
  return {static_cast<std::int64_t>(row[kSeconds]),
          std::bit_cast<double>(row[kFraction])};
}

void RowBuffer::SetStamp(const Stamp& stamp, PackedRow* row) {
  (*row)[kSeconds] = static_cast<PackedWord>(stamp.seconds);
  (*row)[kFraction] = std::bit_cast<PackedWord>(stamp.fraction);
}

RowBuffer::PackedRow RowBuffer::Read(std::size_t row) const {
  PackedRow words(kValues + has_.size());
  rows_.Read(row, words);
  return words;
}

void RowBuffer::Append(const Stamp& stamp, long line, const std::string& path) {
  if (!path.empty() && path != files_.back()) files_.push_back(path);
  PackedRow row(
      kValues + has_.size(),
      std::bit_cast<PackedWord>(std::numeric_limits<double>::quiet_NaN()));
  SetStamp(stamp, &row);
  row[kLine] = static_cast<PackedWord>(line);
  row[kFile] = path.empty() ? 0 : files_.size() - 1;
  rows_.Append(row);
}

void RowBuffer::Restamp(std::size_t row, const Stamp& stamp) {
  PackedRow words = Read(row);
  SetStamp(stamp, &words);
  rows_.Write(row, words);
}

void RowBuffer::Set(std::size_t row, std::size_t field, double value) {
  PackedRow words = Read(row);
  words[kValues + field] = std::bit_cast<PackedWord>(value);
  rows_.Write(row, words);
}

void RowBuffer::Set(const std::string& field, double value) {
  const auto i = FieldIndex(fields_, field);
  if (i) Set(size() - 1, *i, value);
}

void RowBuffer::LeaveOut(const std::string& action, long count) {
  if (count > 0) left_out_.push_back({action, count});
}

long RowBuffer::Sort() {
  struct Place {
    Stamp stamp;
    std::uint32_t row = 0;
  };
  long behind = 0;
  Stamp latest;
  for (std::size_t i = 0; i < size(); ++i) {
    const Stamp stamp = stamp_of(i);
    if (i > 0 && stamp.Since(latest) < 0.0) {
      ++behind;
    } else {
      latest = stamp;
    }
  }
  if (behind == 0) return 0;
  if (size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(path_, 0, "holds too many rows to be sorted");
  }
  std::vector<Place> places;
  places.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    places.push_back({stamp_of(i), static_cast<std::uint32_t>(i)});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    const double since = a.stamp.Since(b.stamp);
    return since < 0.0 || (since == 0.0 && a.row < b.row);
  });
  order_.reserve(size());
  for (const Place& place : places) order_.push_back(place.row);
  return behind;
}

bool RowBuffer::Next() {
  if (next_ == size()) return false;
  const PackedRow row = Read(order_.empty() ? next_ : order_[next_]);
  ++next_;
  stamp_ = StampIn(row);
  line_ = static_cast<long>(row[kLine]);
  file_ = row[kFile];
  for (std::size_t i = 0; i < has_.size(); ++i) {
    values_[i] = std::bit_cast<double>(row[kValues + i]);
    if (!has_[i] || std::isfinite(values_[i])) continue;
    if (!allow_absent_ || !std::isnan(values_[i])) {
      Fail(std::string("the value of ") + fields_[i].name +
           " is not a finite number");
    }
  }
  return true;
}

const std::string& RowBuffer::row_path() const { return files_[file_]; }

RowBuffer Buffered(RowSource* rows, const std::vector<FieldName>& fields,
                   bool allow_absent) {
  RowBuffer buffer(rows->path(), fields, allow_absent);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (rows->Has(i)) buffer.Declare(i);
  }
  while (rows->Next()) {
    buffer.Append(rows->stamp(), rows->line(), rows->row_path());
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
