#include "app/result_folder.h"

#include <unistd.h>

#include <system_error>

#include "base/error.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

/// `folder` without a trailing slash, absolute, so that it has a parent.
fs::path Normalized(const std::string& folder) {
  fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

fs::path Sibling(const fs::path& folder, const std::string& role) {
  return folder.parent_path() / ("." + folder.filename().string() + "." + role +
                                 "-" + std::to_string(getpid()));
}

void CheckMayReplace(const fs::path& folder, bool force,
                     const std::string& marker) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return;
  if (!fs::is_directory(folder, error)) {
    throw InputError("output " + folder.string() + " exists and is no folder");
  }
  if (!force) {
    throw InputError("output folder " + folder.string() +
                     " exists; choose another or replace it with --force");
  }
  if (!fs::is_empty(folder, error) && !fs::exists(folder / marker, error)) {
    throw InputError("output folder " + folder.string() + " holds no " +
                     marker +
                     " of an earlier run; --force does not replace it");
  }
}

}  // namespace

ResultFolder::ResultFolder(const std::string& folder, bool force,
                           const std::string& marker)
    : folder_(Normalized(folder)), staging_(Sibling(folder_, "partial")) {
  CheckMayReplace(folder_, force, marker);
  std::error_code error;
  // Making the temporary folder is the one reliable test of being allowed to.
  fs::create_directory(staging_, error);
  if (error) {
    throw InputError("output folder " + folder_.string() +
                     " cannot be written: " + folder_.parent_path().string() +
                     ": " + error.message());
  }
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(staging_, ignored);
}

std::string ResultFolder::Path(const std::string& name) const {
  return (staging_ / name).string();
}

void ResultFolder::Commit() {
  std::error_code error;
  const fs::path replaced = Sibling(folder_, "replaced");
  const bool replaces = fs::exists(folder_, error);
  if (replaces) fs::rename(folder_, replaced, error);
  if (!error) fs::rename(staging_, folder_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(replaced, folder_, ignored);
    throw InputError("output folder " + folder_.string() +
                     " cannot be put in place: " + error.message());
  }
  committed_ = true;
  fs::remove_all(replaced, error);
}

}  // namespace hindsight
