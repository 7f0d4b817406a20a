#ifndef HINDSIGHT_IO_READ_ARRAY_ROWS_H_
#define HINDSIGHT_IO_READ_ARRAY_ROWS_H_

#include <string>

#include "io/read/file_format.h"
#include "io/read/numeric_array.h"

namespace hindsight {

/// Reads the array `name` of a file or folder; "": its only one.
using ArrayReading = NumericArray (*)(const std::string& path,
                                      const std::string& name);

/// Puts rows together from arrays, as the configuration's `columns` say: NAME
/// or NAME:COLUMN, with COLUMN from 1, or a COLUMN alone. All arrays must have the same
/// number of rows. A file without a time needs `rate` (format.ignore_time).
/// Stamps that are whole numbers keep every digit, whatever their unit and
/// scale. With a column week stamps are GPS time.
/// Throws InputError naming file and row, or the configuration, also for a time
/// whose scale is not positive.
OpenedTable OpenArrays(const TableRequest& request, ArrayReading read);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ARRAY_ROWS_H_
