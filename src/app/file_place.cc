#include "app/file_place.h"

#include <filesystem>

#include "app/flags.h"
#include "base/error.h"
#include "io/read/paths.h"

namespace hindsight {

void CheckFilePlace(const std::string& file, const FileWriter& writer) {
  const std::string name = "output file " + file;
  const std::filesystem::path folder =
      std::filesystem::absolute(file).parent_path();
  if (!IsFolder(folder)) {
    throw InputError(name + " cannot be written: there is no folder " +
                     folder.string());
  }
  if (!PathExists(file)) return;
  if (!IsFile(file)) {
    throw InputError(name + " exists and is no regular file");
  }
  if (!FLAGS_force) {
    throw InputError(name +
                     " exists; choose another or replace it with --force");
  }
  if (!writer.wrote(file)) {
    throw InputError(name + " is not as " + writer.name +
                     " wrote it; --force does not replace it");
  }
}

}  // namespace hindsight
