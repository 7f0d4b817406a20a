#ifndef HINDSIGHT_IO_TABLE_H_
#define HINDSIGHT_IO_TABLE_H_

#include <string>
#include <vector>

namespace hindsight {

/// Text in columns for a terminal. The first column is aligned left, the
/// others right; a column whose cells are all empty is left out.
class ReportTable {
 public:
  /// Heading cells may have several lines, separated by '\n'.
  explicit ReportTable(std::vector<std::string> heading);

  /// A row as wide as the heading; "" for a figure that does not exist.
  void AddRow(std::vector<std::string> cells);

  /// Every line ends with '\n' and has no blanks before it.
  std::string Render() const;

 private:
  std::vector<std::string> heading_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_TABLE_H_
