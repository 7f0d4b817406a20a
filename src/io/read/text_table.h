#ifndef HINDSIGHT_IO_READ_TEXT_TABLE_H_
#define HINDSIGHT_IO_READ_TEXT_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <future>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/file_digest.h"
#include "io/read/row_source.h"
#include "io/read/table_layout.h"
#include "io/read/text_lines.h"
#include "io/read/text_row_parser.h"

namespace hindsight {

/// Rows of numbers out of a text file, checked as they are read. Lines are read
/// ahead, some thousands at once, and parsed by other threads while the rows before
/// them are used; rows, and what is wrong with them, come in the order of the file
/// nevertheless.
class TextTable final : public RowSource {
 public:
  struct Options {
    bool allow_truncated_tail = false;  ///< drop a last line that was cut off
    bool allow_absent = false;          ///< empty and NaN values read as NaN
    /// Rows of text, and of another number of columns, are left out.
    bool drop_text = false;
    /// What the file's digest goes to when it was read; may be null.
    ReadDigests* digests = nullptr;
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
    return parser_.layout().fields[field].column >= 0;
  }
  const std::string& path() const override { return lines_->path(); }
  int Columns() const override { return parser_.layout().column_count; }
  /// Lines dropped under allow_truncated_tail and drop_text.
  std::vector<LeftOut> left_out() const override;
  std::size_t RowsHint() const override;

 private:
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);

  /// A row that was read ahead, as the parser left it.
  struct Ahead {
    Stamp stamp;
    long number = 0;
    std::uint32_t begin = 0;  ///< of the line, in Batch::texts
    std::uint32_t length = 0;
    std::uint32_t last_length = 0;  ///< of what is behind the last delimiter
    /// What is wrong with the row, in Batch::problems; kNone: nothing.
    std::uint32_t problem = kNone;
    int columns = 0;
    bool terminated = true;
  };

  /// Lines that were read ahead.
  struct Batch {
    std::string texts;
    std::vector<Ahead> rows;
    std::vector<double> values;  ///< as many as fields, a row
    std::vector<std::string> problems;
    /// What reading ahead ran into after these lines.
    std::exception_ptr trouble;
  };

  /// Takes the next lines; false at the end of the file.
  bool ReadAhead();
  /// Lines that are not parsed yet, in the memory of another batch.
  Batch ReadLines(Batch memory);
  void Parse(Batch* batch) const;
  /// Has lines parsed by others, as many batches as there are threads; the first
  /// one in memory that is used up.
  void GoAhead(Batch memory);
  /// Takes the row that was read ahead into the current one.
  void Take(const Ahead& row, std::size_t index);
  std::string_view LineOf(const Ahead& row) const {
    return std::string_view(batch_.texts).substr(row.begin, row.length);
  }
  /// False if the line may have been cut off inside its last number.
  bool IsLastValueWhole(const Ahead& row, std::string* problem);

  TextLines* lines_;
  TextRowParser parser_;
  Options options_;
  std::string first_row_;
  Batch batch_;
  std::size_t taken_ = 0;  ///< of its rows
  std::int64_t midnight_ =
      0;                    ///< of times of day: the last, from the first [s]
  std::size_t most_ = 1;    ///< lines of a batch
  bool terminated_ = true;  ///< the line of the current row
  long truncated_ = 0;
  long texts_dropped_ = 0;
  std::size_t first_length_ = 0;
  std::uint32_t shortest_last_value_ = kNone;
  bool all_read_ = false;  ///< or trouble was run into
  std::deque<std::future<Batch>> ahead_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_TABLE_H_
