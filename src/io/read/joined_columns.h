#ifndef HINDSIGHT_IO_READ_JOINED_COLUMNS_H_
#define HINDSIGHT_IO_READ_JOINED_COLUMNS_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/file_columns.h"

namespace hindsight {

/// Whether `part` is what follows a file of these columns where a logger writes
/// its titles once.
bool LacksTitles(const FileColumns& part, const FileColumns& titled);

/// The tables of all files as one; nothing if their columns differ. Throws
/// InputError as ReadTextColumns.
std::optional<FileColumns> ReadJoined(const std::vector<std::string>& paths);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_JOINED_COLUMNS_H_
