#ifndef HINDSIGHT_IO_WRITE_COLUMN_FILE_H_
#define HINDSIGHT_IO_WRITE_COLUMN_FILE_H_

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/solution_columns.h"

namespace hindsight {

/// Appends a value, in the column's unit, in its digits; a NaN as nothing.
void AppendValue(const SolutionColumn& column, double value, std::string* out);

/// A file of columns of numbers that takes its rows piece by piece, holds none
/// of them in memory, and appears complete or not at all (AtomicFile).
class ColumnFile {
 public:
  ColumnFile() = default;
  virtual ~ColumnFile() = default;
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;

  /// Adds `rows`: one column of each of the file's columns, in its unit, NaN
  /// where the quantity does not exist. Throws OutputError.
  virtual void Append(const Eigen::MatrixXd& rows) = 0;
  /// Gives the file its name. Throws OutputError.
  virtual void Commit() = 0;
};

/// Rows of a piece by which a long table is handed to a ColumnFile: of the
/// columns of a solution 700 kB, which a cache holds.
inline constexpr std::size_t kRowsOfPiece = 2048;

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_COLUMN_FILE_H_
