#ifndef HINDSIGHT_IO_READ_JOINED_ROWS_H_
#define HINDSIGHT_IO_READ_JOINED_ROWS_H_

#include <string>
#include <vector>

#include "io/read/text_format.h"

namespace hindsight {

/// The files of one stream, read one behind the other as if they were one; each
/// is opened when the one before has ended, and may repeat the titles. Throws
/// InputError as OpenTable does, and for a file that does not hold the
/// quantities, the number of columns or the kind of stamps of the first. Time
/// is the caller's to check, by RowSource::part.
OpenedTable OpenJoined(const std::vector<std::string>& paths,
                       const TextFormat& format,
                       const std::vector<FieldName>& fields,
                       TextTable::Options options);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_JOINED_ROWS_H_
