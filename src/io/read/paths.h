#ifndef HINDSIGHT_IO_READ_PATHS_H_
#define HINDSIGHT_IO_READ_PATHS_H_

#include <filesystem>
#include <vector>

namespace hindsight {

/// Whether `path` names anything. A path the system does not take (too long, or
/// through a folder that may not be entered) names nothing. Never throws.
bool PathExists(const std::filesystem::path& path);

/// Whether `path` names a folder; otherwise as PathExists.
bool IsFolder(const std::filesystem::path& path);

/// Whether `path` names a regular file; otherwise as PathExists.
bool IsFile(const std::filesystem::path& path);

/// What `folder` holds, sorted by name. Throws InputError where it cannot be
/// listed.
std::vector<std::filesystem::path> FolderEntries(
    const std::filesystem::path& folder);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_PATHS_H_
