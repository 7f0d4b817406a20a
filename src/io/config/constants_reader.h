#ifndef HINDSIGHT_IO_CONFIG_CONSTANTS_READER_H_
#define HINDSIGHT_IO_CONFIG_CONSTANTS_READER_H_

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/recorded_constants.h"
#include "io/read/file_digest.h"

namespace hindsight {

/// The file that holds the figures of a result: `path` itself, or summary.json
/// in the folder of that name.
std::filesystem::path SummaryOf(const std::filesystem::path& path);

/// The constants of a result of `run` or `combine` (SummaryOf), of `method` or,
/// where that is empty, of its best method. Biases of the IMU, which are those
/// of one switching-on, are left out. Throws InputError if there are no such
/// figures, or they are of a result that is not usable.
RecordedConstants ReadConstants(const std::filesystem::path& path,
                                const std::string& method);

/// What a result was made of, as its summary.json says: the files of its
/// recording, or recordings. Configurations, which recordings may share, are left
/// out. Throws InputError if it cannot be read.
std::vector<FileDigest> RecordedFiles(const std::filesystem::path& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONSTANTS_READER_H_
