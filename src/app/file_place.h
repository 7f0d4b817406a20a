#ifndef HINDSIGHT_APP_FILE_PLACE_H_
#define HINDSIGHT_APP_FILE_PLACE_H_

#include <functional>
#include <string>

namespace hindsight {

/// Who writes a file that is named with --out.
struct FileWriter {
  std::string name;                               ///< "'init'"
  std::function<bool(const std::string&)> wrote;  ///< a regular file
};

/// Throws InputError unless `writer` may give `file` its content: the folder is
/// there, and either nothing has that name or, with --force, a regular file
/// that `writer` wrote, reached by a link or not. A recording in the folder
/// looks like any other file to be replaced, and a device does too.
void CheckFilePlace(const std::string& file, const FileWriter& writer);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_FILE_PLACE_H_
