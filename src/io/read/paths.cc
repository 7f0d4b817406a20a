#include "io/read/paths.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.h"

namespace hindsight {

namespace fs = std::filesystem;

bool PathExists(const fs::path& path) {
  std::error_code refused;
  return fs::exists(path, refused);
}

bool IsFolder(const fs::path& path) {
  std::error_code refused;
  return fs::is_directory(path, refused);
}

bool IsFile(const fs::path& path) {
  std::error_code refused;
  return fs::is_regular_file(path, refused);
}

std::vector<fs::path> FolderEntries(const fs::path& folder) {
  std::error_code refused;
  std::vector<fs::path> entries;
  fs::directory_iterator entry(folder, refused);
  while (!refused && entry != fs::directory_iterator()) {
    entries.push_back(entry->path());
    entry.increment(refused);
  }
  if (refused) {
    throw InputError(folder.string(), 0,
                     "the folder cannot be listed: " + refused.message());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace hindsight
