#ifndef HINDSIGHT_IO_READ_COLUMN_GATHERER_H_
#define HINDSIGHT_IO_READ_COLUMN_GATHERER_H_

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/read/file_columns.h"
#include "io/read/row_word.h"
#include "io/read/text_shape.h"

namespace hindsight {

/// Makes columns out of the lines of a table, as ReadTextColumns says.
class ColumnGatherer {
 public:
  /// Of lines that `rows` tells from others.
  explicit ColumnGatherer(RowWord rows = {}) {
    found_.row_word = std::move(rows);
  }

  /// Takes the next line; `terminated`: its end stands behind it.
  void Add(std::string_view line, bool terminated);
  /// False of what is no table, and once as many numbers are kept as are looked
  /// at.
  bool wants_more() const { return !shapeless_ && found_.complete; }
  /// What was found; nothing of fewer than kFewestRows rows.
  std::optional<FileColumns> Finish();

 private:
  std::size_t columns() const { return shape_->is_text.size(); }
  void FindShapeOfEarly();
  void ChooseDateOrders();
  void Take(std::string_view line, bool terminated);
  void TakeWord(std::size_t i);
  bool HoldsTheSame() const;
  void Remark();
  void TakeUnitsIntoTitle();
  void NameColumns();
  bool SharesTitle() const;
  void SkipZeroRows();

  std::vector<std::string> early_lines_;  ///< by which the shape is told
  bool early_terminated_ = true;          ///< the last of them
  std::size_t early_texts_ = 0;           ///< of them no comments
  int early_searches_ = 0;
  std::optional<Shape> shape_;
  bool shapeless_ = false;
  FileColumns found_;
  std::vector<Word> words_;
  std::vector<bool> is_known_;                    ///< per column: what it holds
  std::vector<std::vector<double>> month_first_;  ///< per column: Word's
  bool halves_of_day_ = false;                    ///< AM or PM in the first row
  std::string title_;
  std::string above_title_;
  std::string comment_;
  bool titled_ = false;
  int number_ = 0;
  int early_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COLUMN_GATHERER_H_
