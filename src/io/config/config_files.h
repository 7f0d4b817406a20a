#ifndef HINDSIGHT_IO_CONFIG_CONFIG_FILES_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_FILES_H_

#include <filesystem>

#include "io/config/config_recording.h"

namespace hindsight {

/// The folder of the files by the key `folder`: beside the configuration, or
/// below the data root; written into `top` as resolved. Throws InputError if
/// there is none.
std::filesystem::path FindFolder(ConfigMap* top, const LoadOptions& options);

/// Throws InputError naming all declared files that are missing at once.
void RequireFiles(const DeclaredRecording& declared);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_FILES_H_
