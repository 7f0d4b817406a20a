#ifndef HINDSIGHT_APP_RESULT_FOLDER_H_
#define HINDSIGHT_APP_RESULT_FOLDER_H_

#include <filesystem>
#include <string>

namespace hindsight {

/// A folder of results that appears complete or not at all: files are written
/// into a temporary folder beside it, which Commit() gives the final name.
class ResultFolder {
 public:
  /// Throws InputError if `folder` exists and `force` is false; if it exists,
  /// is neither empty nor holds a file named `marker`, which says that an
  /// earlier run wrote it; or if its parent cannot be written.
  ResultFolder(const std::string& folder, bool force,
               const std::string& marker);
  /// Removes the temporary folder unless committed.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// Path at which the results' file `name` is to be written now.
  std::string Path(const std::string& name) const;
  /// The temporary folder.
  const std::filesystem::path& staging() const { return staging_; }
  /// The final folder.
  const std::filesystem::path& folder() const { return folder_; }

  /// Puts the results in place, replacing a folder that is there already.
  void Commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
  bool committed_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RESULT_FOLDER_H_
