#ifndef HINDSIGHT_IO_READ_TEXT_LAYOUT_H_
#define HINDSIGHT_IO_READ_TEXT_LAYOUT_H_

#include <string>
#include <string_view>
#include <vector>

#include "io/read/text_format.h"

namespace hindsight {

/// The titles of a table's columns.
struct TableHeader {
  std::vector<std::string_view> titles;
  long line = 0;  ///< in the file; 0: there is no header
};

/// The columns of an own CSV file whose titles name one of `fields`. Throws
/// InputError if one stands twice.
std::vector<ColumnMapping> TitledColumns(const std::string& path,
                                         const TableHeader& header,
                                         const std::vector<FieldName>& fields);

/// Where each of `fields` stands in a file with these columns. Throws
/// InputError for a missing title, a missing time, and a unit that does not fit
/// its column.
TableLayout BuildLayout(const std::string& path, const TextFormat& format,
                        const std::vector<FieldName>& fields,
                        const std::vector<ColumnMapping>& columns,
                        const TableHeader& header);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TEXT_LAYOUT_H_
