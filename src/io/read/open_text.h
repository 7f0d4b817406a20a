#ifndef HINDSIGHT_IO_READ_OPEN_TEXT_H_
#define HINDSIGHT_IO_READ_OPEN_TEXT_H_

#include <string>
#include <vector>

#include "io/read/file_format.h"
#include "io/read/row_buffer.h"

namespace hindsight {

/// Column number from 1, quantity, unit.
ColumnMapping ColumnAt(int number, const std::string& quantity,
                       const char* unit);
/// Three columns from `number` on: the quantities stem_x, stem_y, stem_z.
void AppendVector(int number, const std::string& stem, const char* unit,
                  std::vector<ColumnMapping>* columns);

/// The file behind the lines that are skipped.
OpenedTable OpenLines(const TableRequest& request);

/// Delimited text with these columns; those without a number are found in a
/// header line. Throws InputError if there are none: the format holds no such
/// stream.
OpenedTable OpenColumns(const TableRequest& request,
                        const std::vector<ColumnMapping>& columns);

/// The own CSV, whose header line names the columns.
OpenedTable OpenTitled(const TableRequest& request);

/// Rows in memory as a table.
OpenedTable OpenBuffer(RowBuffer rows, bool dated);

/// The numbers of a line between blanks; none if one of them is not a number.
std::vector<double> NumbersOf(const std::string& line);

[[noreturn]] void FailWithoutRows(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_OPEN_TEXT_H_
