#ifndef HINDSIGHT_IO_READ_PLAIN_ROWS_H_
#define HINDSIGHT_IO_READ_PLAIN_ROWS_H_

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "io/read/table_layout.h"
#include "io/read/time_scale.h"

namespace hindsight {

/// Reads rows that are as plain as most: a stamp in seconds and numbers with one
/// delimiter between two, neither blanks nor quotation marks. TextRowParser reads
/// the same of them in twice the time, as it has to ask of each column what it is.
class PlainRows {
 public:
  /// Of no layout: no row is plain.
  PlainRows() = default;
  /// Of a layout with a known number of columns. No row is plain where it asks for
  /// more than numbers and such stamps.
  explicit PlainRows(const TableLayout& layout);

  /// Fills `values`, one a field and NaN for those that the table does not have,
  /// and the others. False, and nothing that was filled counts, for a row that is
  /// not plain or is wrong. `last_length` is that of its last column.
  bool Read(std::string_view row, std::span<double> values, Stamp* stamp,
            std::size_t* last_length) const;

 private:
  static constexpr int kSkipped = -1;
  static constexpr int kTime = -2;
  struct Column {
    int field = kSkipped;
    double factor = 1.0;  ///< of a stamp, ticks a second
  };

  bool SetField(std::size_t i, const TableLayout::Field& field);

  std::vector<Column> columns_;  ///< none: no row is plain
  std::vector<std::size_t> absent_;
  char delimiter_ = ',';
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_PLAIN_ROWS_H_
