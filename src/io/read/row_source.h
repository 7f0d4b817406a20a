#ifndef HINDSIGHT_IO_READ_ROW_SOURCE_H_
#define HINDSIGHT_IO_READ_ROW_SOURCE_H_

#include <string>
#include <vector>

#include "io/read/time_scale.h"

namespace hindsight {

/// Rows that a reader left out, counted for the report.
struct LeftOut {
  std::string action;  ///< "truncated last line dropped"
  long count = 0;
};

/// Stamped rows of numbers in SI units, whatever file they come from. The
/// fields are those that the reader was opened with, in their order.
class RowSource {
 public:
  virtual ~RowSource() = default;

  /// Reads the next row; false at the end. Throws InputError naming the place
  /// for whatever makes a row unusable.
  virtual bool Next() = 0;
  /// True if the file holds the field at all.
  virtual bool Has(std::size_t field) const = 0;
  /// Throws InputError for the current row.
  [[noreturn]] void Fail(const std::string& message) const;
  /// Rows that the file is likely to hold.
  virtual std::size_t RowsHint() const = 0;
  virtual const std::string& path() const = 0;
  /// The file that the current row stands in.
  virtual const std::string& row_path() const { return path(); }
  /// Of several files of one stream, which the current row stands in, from 0.
  virtual std::size_t part() const { return 0; }
  /// Of delimited text, the columns of a row; 0 of other sources.
  virtual int Columns() const { return 0; }
  virtual std::vector<LeftOut> left_out() const { return {}; }

  /// Of the current row, as the file gives it.
  const Stamp& stamp() const { return stamp_; }
  /// In SI; NaN if absent.
  double value(std::size_t field) const {
    return elsewhere_ == nullptr ? values_[field] : elsewhere_[field];
  }
  /// Line or row number in the file, from 1.
  long line() const { return line_; }

 protected:
  Stamp stamp_;
  std::vector<double> values_;
  /// Where the row's values stand, if not there: so they need not be copied.
  const double* elsewhere_ = nullptr;
  long line_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ROW_SOURCE_H_
