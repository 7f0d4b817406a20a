#ifndef HINDSIGHT_IO_READ_ROW_BUFFER_H_
#define HINDSIGHT_IO_READ_ROW_BUFFER_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/packed_columns.h"
#include "io/read/fields.h"
#include "io/read/row_source.h"

namespace hindsight {

/// Rows held in memory: what formats yield that are not read line by line. A
/// value that was not set is absent.
class RowBuffer final : public RowSource {
 public:
  /// Unless `allow_absent`, a row with an absent or infinite value in a field
  /// that the buffer holds is an error when it is read.
  RowBuffer(std::string path, const std::vector<FieldName>& fields,
            bool allow_absent);

  /// Declares that the buffer holds the field; false if nobody asked for it.
  bool Declare(const std::string& field);
  void Declare(std::size_t field) { has_[field] = true; }
  /// Adds a row of absent values. `path` is empty for the buffer's own.
  void Append(const Stamp& stamp, long line, const std::string& path = "");
  void Restamp(std::size_t row, const Stamp& stamp);
  /// Sets a value of the last row if the field was asked for.
  void Set(const std::string& field, double value);
  void Set(std::size_t row, std::size_t field, double value);
  void LeaveOut(const std::string& action, long count);
  /// Into the order of the stamps, equal ones as they are. Returns the number
  /// of rows that stood behind a later one.
  long Sort();

  std::size_t size() const { return rows_.size(); }
  Stamp stamp_of(std::size_t row) const { return StampIn(Read(row)); }

  bool Next() override;
  bool Has(std::size_t field) const override { return has_[field]; }
  std::size_t RowsHint() const override { return size(); }
  const std::string& path() const override { return path_; }
  const std::string& row_path() const override;
  std::vector<LeftOut> left_out() const override { return left_out_; }

 private:
  /// What stands in a row, the values behind it.
  enum Place : std::size_t { kSeconds, kFraction, kLine, kFile, kValues };
  using PackedRow = std::vector<PackedWord>;

  static Stamp StampIn(const PackedRow& row);
  static void SetStamp(const Stamp& stamp, PackedRow* row);
  PackedRow Read(std::size_t row) const;

  std::string path_;
  const std::vector<FieldName>& fields_;
  bool allow_absent_;
  std::vector<bool> has_;
  PackedColumns rows_;
  std::vector<std::uint32_t> order_;  ///< of the rows; empty: as they are
  std::size_t file_ = 0;              ///< of the current row
  std::vector<std::string> files_;
  std::vector<LeftOut> left_out_;
  std::size_t next_ = 0;
};

/// All rows of another source.
RowBuffer Buffered(RowSource* rows, const std::vector<FieldName>& fields,
                   bool allow_absent);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ROW_BUFFER_H_
