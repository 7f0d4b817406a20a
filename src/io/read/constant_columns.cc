#include "io/read/constant_columns.h"

#include <limits>
#include <optional>
#include <utility>

namespace hindsight {
namespace {

class CompletedRows final : public RowSource {
 public:
  CompletedRows(std::unique_ptr<RowSource> source,
                const std::vector<ConstantColumn>& constants,
                const std::vector<FieldName>& fields)
      : source_(std::move(source)), constants_(fields.size()) {
    values_.assign(fields.size(), std::numeric_limits<double>::quiet_NaN());
    for (const ConstantColumn& constant : constants) {
      if (const auto field = FieldIndex(fields, constant.quantity)) {
        constants_[*field] = constant.value;
      }
    }
  }

  bool Next() override {
    if (!source_->Next()) return false;
    stamp_ = source_->stamp();
    line_ = source_->line();
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      if (constants_[i]) {
        values_[i] = *constants_[i];
      } else if (source_->Has(i)) {
        values_[i] = source_->value(i);
      }
    }
    return true;
  }
  bool Has(std::size_t field) const override {
    return constants_[field].has_value() || source_->Has(field);
  }
  std::size_t RowsHint() const override { return source_->RowsHint(); }
  const std::string& path() const override { return source_->path(); }
  const std::string& row_path() const override { return source_->row_path(); }
  int Columns() const override { return source_->Columns(); }
  std::vector<LeftOut> left_out() const override { return source_->left_out(); }

 private:
  std::unique_ptr<RowSource> source_;
  std::vector<std::optional<double>> constants_;  ///< of each field
};

}  // namespace

std::unique_ptr<RowSource> WithConstants(
    std::unique_ptr<RowSource> source,
    const std::vector<ConstantColumn>& constants,
    const std::vector<FieldName>& fields) {
  if (constants.empty()) return source;
  return std::make_unique<CompletedRows>(std::move(source), constants, fields);
}

}  // namespace hindsight
