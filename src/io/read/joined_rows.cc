#include "io/read/joined_rows.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

class JoinedRows final : public RowSource {
 public:
  JoinedRows(std::vector<std::string> paths, TextFormat format,
             const std::vector<FieldName>& fields, TextTable::Options options)
      : paths_(std::move(paths)),
        format_(std::move(format)),
        fields_(fields),
        options_(options),
        opened_(OpenTable(paths_.front(), format_, fields_, options_)),
        dated_(opened_.dated) {
    values_.assign(fields_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      has_.push_back(opened_.table->Has(i));
    }
  }

  bool Next() override {
    while (!opened_.table->Next()) {
      KeepLeftOut();
      if (part_ + 1 == paths_.size()) return false;
      OpenPart(part_ + 1);
    }
    const RowSource& rows = *opened_.table;
    if (columns_ == 0) columns_ = rows.Columns();
    if (rows.Columns() != columns_) {
      rows.Fail("has " + std::to_string(rows.Columns()) + " columns, and " +
                paths_.front() + " " + std::to_string(columns_) +
                "; expected files of one stream with the same columns");
    }
    stamp_ = rows.stamp();
    line_ = rows.line();
    for (std::size_t i = 0; i < has_.size(); ++i) {
      if (has_[i]) values_[i] = rows.value(i);
    }
    return true;
  }
  bool Has(std::size_t field) const override { return has_[field]; }
  std::size_t RowsHint() const override {
    return opened_.table->RowsHint() * paths_.size();
  }
  const std::string& path() const override { return paths_.front(); }
  const std::string& row_path() const override {
    return opened_.table->row_path();
  }
  std::size_t part() const override { return part_; }
  std::vector<LeftOut> left_out() const override { return left_out_; }

  bool dated() const { return dated_; }

 private:
  void OpenPart(std::size_t part) {
    const std::string& path = paths_[part];
    opened_ = OpenTable(path, format_, fields_, options_);
    part_ = part;
    for (std::size_t i = 0; i < has_.size(); ++i) {
      if (opened_.table->Has(i) == has_[i]) continue;
      throw InputError(
          path, 0,
          std::string(has_[i] ? "has no column " : "has a column ") +
              fields_[i].name + ", unlike " + paths_.front() +
              "; expected files of one stream with the same "
              "columns");
    }
    if (opened_.dated == dated_) return;
    throw InputError(path, 0,
                     std::string("stamps are ") +
                         (dated_ ? "no dates" : "dates") +
                         ", unlike those of " + paths_.front());
  }

  void KeepLeftOut() {
    for (const LeftOut& left : opened_.table->left_out()) {
      const auto same = std::find_if(
          left_out_.begin(), left_out_.end(),
          [&](const LeftOut& other) { return other.action == left.action; });
      if (same == left_out_.end()) {
        left_out_.push_back(left);
      } else {
        same->count += left.count;
      }
    }
  }

  const std::vector<std::string> paths_;
  const TextFormat format_;
  const std::vector<FieldName>& fields_;
  const TextTable::Options options_;
  OpenedTable opened_;
  const bool dated_;
  std::vector<bool> has_;
  std::size_t part_ = 0;
  int columns_ = 0;
  std::vector<LeftOut> left_out_;
};

}  // namespace

OpenedTable OpenJoined(const std::vector<std::string>& paths,
                       const TextFormat& format,
                       const std::vector<FieldName>& fields,
                       TextTable::Options options) {
  if (paths.size() == 1) {
    return OpenTable(paths.front(), format, fields, options);
  }
  auto rows = std::make_unique<JoinedRows>(paths, format, fields, options);
  OpenedTable opened;
  opened.dated = rows->dated();
  opened.table = std::move(rows);
  return opened;
}

}  // namespace hindsight
