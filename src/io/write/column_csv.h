#ifndef HINDSIGHT_IO_WRITE_COLUMN_CSV_H_
#define HINDSIGHT_IO_WRITE_COLUMN_CSV_H_

#include <string>
#include <vector>

#include "io/write/atomic_file.h"
#include "io/write/column_file.h"

namespace hindsight {

/// As text: the comments, a line of titles, a line a row, separated by commas;
/// a field of NaN is empty.
class ColumnCsv : public ColumnFile {
 public:
  /// `comments` are whole lines. Throws OutputError.
  ColumnCsv(const std::string& path, const std::string& comments,
            std::vector<SolutionColumn> columns);

  void Append(const Eigen::MatrixXd& rows) override;
  /// Adds them and, of lines that are made once, `some` to a file of the same columns;
  /// `some` has one entry a row.
  void Append(const Eigen::MatrixXd& rows, const std::vector<bool>& some,
              ColumnCsv* other);
  void Commit() override;

 private:
  void AppendLine(const Eigen::MatrixXd& rows, Eigen::Index k,
                  std::string* out) const;

  AtomicFile file_;
  std::vector<SolutionColumn> columns_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_COLUMN_CSV_H_
