#ifndef HINDSIGHT_IO_READ_TEXT_TABLE_H_
#define HINDSIGHT_IO_READ_TEXT_TABLE_H_

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/row_source.h"
#include "io/read/text_lines.h"
#include "io/read/time_scale.h"

namespace hindsight {

/// Which column of a table holds what. Columns count from 0; -1 is none.
struct TableLayout {
  struct Field {
    std::string name;     ///< of the quantity, for messages
    int column = -1;      ///< -1: the table does not have it
    double factor = 1.0;  ///< to SI, sign included
  };
  std::vector<Field> fields;

  /// How the stamp is written.
  enum class Clock {
    kNone,     ///< there is no stamp: Stamp{}
    kSeconds,  ///< time_column, in 1/ticks_per_second
    kWeek,     ///< GPS week in time_column, seconds of week after it
    kDate,     ///< yyyy/mm/dd in time_column, hh:mm:ss.sss in another, GPST
    kDateUtc,  ///< the same in UTC
    kIso,      ///< ISO 8601 in time_column, GPST
    kIsoUtc,   ///< the same in UTC
  };
  Clock clock = Clock::kSeconds;
  int time_column = -1;
  int clock_column = -1;  ///< of dates: hh:mm:ss.sss; -1: right of the date
  std::int64_t ticks_per_second = 1;

  char delimiter = ',';         ///< ' ': any run of blanks
  bool comma_is_blank = false;  ///< with ' ': commas separate too
  /// Columns each row must have; 0: as many as the first row.
  int column_count = 0;
};

/// Columns of the line, and the delimiter that would split it: ',' ';' or
/// blanks.
char GuessDelimiter(std::string_view line);
std::vector<std::string_view> SplitLine(std::string_view line, char delimiter,
                                        bool comma_is_blank = false);

/// True for a line that is empty or starts with '#' or '%'.
bool IsComment(std::string_view line);

/// Rows of numbers out of a text file, checked as they are read.
class TextTable final : public RowSource {
 public:
  struct Options {
    bool allow_truncated_tail = false;  ///< drop a last line that was cut off
    bool allow_absent = false;          ///< empty and NaN values read as NaN
    /// Rows of text, and of another number of columns, are left out.
    bool drop_text = false;
  };

  /// `first_row` is the first line of data if it was read already, else empty.
  /// `lines` must outlive the table.
  TextTable(TextLines* lines, TableLayout layout, Options options,
            std::string first_row);

  /// Reads the next row; comments are passed over. False at the end. Throws
  /// InputError naming file, line and column for text, NaN or infinity where a
  /// number belongs, a wrong number of columns, and a truncated last line. A
  /// last line without line end is legal; it counts as truncated if it does not
  /// parse, or if its last value, when that is read, is shorter than those of
  /// all lines before.
  bool Next() override;
  bool Has(std::size_t field) const override {
    return layout_.fields[field].column >= 0;
  }
  const std::string& path() const override { return lines_->path(); }
  int Columns() const override { return layout_.column_count; }
  /// Lines dropped under allow_truncated_tail and drop_text.
  std::vector<LeftOut> left_out() const override;
  std::size_t RowsHint() const override;

 private:
  /// The next line that is no comment; false at the end.
  bool NextLine(std::string_view* line);
  bool Parse(std::string_view line, std::string* problem);
  bool ParseTime(const std::vector<std::string_view>& time_tokens,
                 std::string* problem);
  /// False if the line may have been cut off inside its last number.
  bool IsLastValueWhole(std::string_view line, std::string* problem);
  std::string ColumnName(int column) const;

  TextLines* lines_;
  TableLayout layout_;
  Options options_;
  std::string first_row_;
  std::vector<char> wanted_;  ///< per column: 0 skip, 1 number, 2 part of time
  std::vector<double> raw_;
  std::vector<std::string_view> time_tokens_;
  long truncated_ = 0;
  long texts_ = 0;
  std::size_t first_length_ = 0;
  static constexpr std::size_t kNoLength = static_cast<std::size_t>(-1);
  std::size_t shortest_last_value_ = kNoLength;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_TABLE_H_
