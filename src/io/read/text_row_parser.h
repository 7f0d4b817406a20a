#ifndef HINDSIGHT_IO_READ_TEXT_ROW_PARSER_H_
#define HINDSIGHT_IO_READ_TEXT_ROW_PARSER_H_

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/plain_rows.h"
#include "io/read/table_layout.h"
#include "io/read/time_scale.h"

namespace hindsight {

/// Numbers and stamp of one line of a text table. Several threads may parse
/// with one parser, each with a Scratch of its own.
class TextRowParser {
 public:
  struct Scratch {
    std::vector<double> raw;
    std::vector<std::string_view> time_tokens;
    std::string pointed;  ///< a line whose decimal commas are points
  };

  /// `allow_absent`: empty and NaN values read as NaN.
  TextRowParser(TableLayout layout, bool allow_absent);

  const TableLayout& layout() const { return layout_; }
  /// Rows of another number of columns are wrong from here on.
  void FixColumnCount(int count);
  /// Columns from the first to the last that is wanted.
  std::size_t wanted() const { return wanted_.size(); }
  /// "column 3 (gyro_x)"; columns count from 0.
  std::string ColumnName(int column) const;

  /// Fills `values`, one a field and NaN for those that the table does not have,
  /// and the rest. Returns what is wrong, "" if all is right.
  /// `last_length` is that of what stands behind the last delimiter or blank.
  std::string Parse(std::string_view line, Scratch* scratch,
                    std::span<double> values, Stamp* stamp, int* columns,
                    std::size_t* last_length) const;

 private:
  std::string ParseAny(std::string_view line, Scratch* scratch,
                       std::span<double> values, Stamp* stamp,
                       int* columns) const;
  std::size_t LastLength(std::string_view line) const;
  bool IsBad(double value) const;
  std::string ParseTime(const std::vector<std::string_view>& time_tokens,
                        Stamp* stamp) const;

  TableLayout layout_;
  bool allow_absent_;
  std::vector<char>
      wanted_;  ///< per column: 0 skip, 1 number, 2 part of time, 3 place
  PlainRows plain_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_ROW_PARSER_H_
