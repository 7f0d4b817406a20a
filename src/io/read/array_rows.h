#ifndef HINDSIGHT_IO_READ_ARRAY_ROWS_H_
#define HINDSIGHT_IO_READ_ARRAY_ROWS_H_

#include <memory>
#include <string>
#include <vector>

#include "io/read/row_source.h"
#include "io/read/text_format.h"

namespace hindsight {

/// Puts rows together from arrays, as the configuration's `columns` say: NAME
/// or NAME:COLUMN, with COLUMN from 1. For npy, NAME is a file below `path`, if
/// that is a folder; or `path` is the file and a COLUMN alone is named. For
/// mat, NAME is a variable of the file `path`. All arrays must have the same
/// number of rows. A file without a time needs `rate` (format.ignore_time).
/// Stamps that are whole numbers keep every digit, whatever their unit and
/// scale. With a column week stamps are GPS time and `dated` becomes true.
/// Throws InputError naming file and row, or the configuration, also for a time
/// whose scale is not positive.
std::unique_ptr<RowSource> OpenArrays(const std::string& path,
                                      const TextFormat& format,
                                      const std::vector<FieldName>& fields,
                                      bool allow_absent, bool* dated);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_ARRAY_ROWS_H_
