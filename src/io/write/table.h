#ifndef HINDSIGHT_IO_WRITE_TABLE_H_
#define HINDSIGHT_IO_WRITE_TABLE_H_

#include <cstddef>
#include <string>
#include <vector>

namespace hindsight {

/// What a terminal can show.
struct TableStyle {
  std::size_t width = 0;  ///< columns of letters, 0: any number
  bool colour = false;    ///< by ANSI sequences
};

/// The grade in its colour, if the style has any; other text as it is.
std::string PaintGrade(const std::string& grade, const TableStyle& style);

/// Text in columns for a terminal. The first column is aligned left, the
/// others right; a column whose cells are all empty is left out.
class ReportTable {
 public:
  /// Heading cells may have several lines, separated by '\n'.
  /// The first `keys` columns say what a row is of.
  explicit ReportTable(std::vector<std::string> heading, std::size_t keys = 1);

  /// A row as wide as the heading; "" for a figure that does not exist.
  void AddRow(std::vector<std::string> cells);

  /// Every line ends with '\n' and has no blanks before it. Columns beyond the
  /// style's width come in further tables below, an empty line apart, each with
  /// the keys again.
  std::string Render(const TableStyle& style = {}) const;

 private:
  std::vector<std::string> heading_;
  std::size_t keys_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_TABLE_H_
