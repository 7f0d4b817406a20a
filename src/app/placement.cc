#include "app/placement.h"

#include <system_error>

#include "app/error_line.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/write/output_error.h"
#include "io/write/result_manifest.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

fs::path Resolved(const std::string& folder) {
  const fs::path given = fs::absolute(folder);
  std::error_code refused;
  fs::path path = fs::weakly_canonical(given, refused);
  if (refused) path = given.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

std::optional<struct stat> StatusOf(const fs::path& path) {
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

bool LiesIn(const fs::path& inner, const fs::path& folder) {
  std::error_code refused;
  fs::path path = fs::weakly_canonical(fs::absolute(inner), refused);
  while (!refused) {
    if (fs::equivalent(path, folder, refused)) return true;
    if (path == path.parent_path()) return false;
    refused.clear();
    path = path.parent_path();
  }
  return false;
}

}  // namespace

Placement::Placement(const OutputRequest& request,
                     const std::function<Paths()>& inputs)
    : force_(request.force), folder_(Resolved(request.folder)) {
  held_ = HoldFolder(folder_);
  replaced_ = CheckMayReplace(inputs);
}

void Placement::CheckHolds(const std::function<Paths()>& inputs) const {
  const std::string name = "output folder " + folder_.string();
  for (const fs::path& input : inputs()) {
    if (!LiesIn(input, folder_)) continue;
    throw InputError(name + " holds " + input.string() +
                     ", which is an input; choose another");
  }
  std::error_code refused;
  const fs::path working = fs::current_path(refused);
  if (refused || !LiesIn(working, folder_)) return;
  throw InputError(
      name + (working == folder_ ? " is" : " holds") +
      " the working directory, which the results would leave without a name; "
      "choose a folder in it");
}

std::optional<struct stat> Placement::CheckMayReplace(
    const std::function<Paths()>& inputs) const {
  const std::optional<struct stat> status = StatusOf(folder_);
  if (!status) return std::nullopt;
  const std::string name = "output folder " + folder_.string();
  if (!S_ISDIR(status->st_mode)) {
    throw InputError("output " + folder_.string() + " exists and is no folder");
  }
  CheckHolds(inputs);
  const std::optional<struct stat> parent = StatusOf(folder_.parent_path());
  if (parent && parent->st_dev != status->st_dev) {
    throw InputError(name +
                     " is a mount point, which cannot be put in place in one "
                     "step; choose a folder in it");
  }
  if (FolderEntries(folder_).empty()) return status;
  if (!force_) {
    throw InputError(name +
                     " exists; choose another or replace it with --force");
  }
  const std::string objection = Objection(folder_, true);
  if (objection.empty()) return status;
  throw InputError(name + " " + objection + "; --force does not replace it");
}

void Placement::Place(const fs::path& finished, bool complete) {
  finished_ = finished;
  complete_ = complete;
  if (const std::error_code error = SyncFolder(finished_)) {
    throw OutputError("output folder " + folder_.string() +
                      " cannot be written: " + error.message());
  }
  if (replaced_ && StatusOf(folder_)) {
    Replace();
    return;
  }
  std::error_code error;
  fs::rename(finished_, folder_, error);
  if (error) {
    PlaceBeside(error.message());
    return;
  }
  TakenFrom("");
}

/// The name is that of the results; what it was before is now `old`.
void Placement::TakenFrom(const fs::path& old) {
  placed_ = folder_;
  if (const std::error_code error = SyncFolder(folder_.parent_path())) {
    throw OutputError(
        "output folder " + folder_.string() +
        " is in place, but may be lost with the power: " + error.message());
  }
  if (old.empty() || RemoveListed(old)) return;
  PrintNote("what " + folder_.string() + " held is left in " + old.string());
}

void Placement::PlaceBeside(const std::string& reason) {
  if (!StatusOf(finished_)) {
    throw OutputError("output folder " + folder_.string() +
                      " cannot be put in place: " + reason);
  }
  placed_ = finished_;
  // The folder's name, where the results are now.
  const fs::path name = finished_.parent_path() / folder_.filename();
  for (int i = 1; i < 10000; ++i) {
    const fs::path beside = name.string() + "." + std::to_string(i);
    std::error_code error;
    if (StatusOf(beside) || !fs::create_directory(beside, error)) {
      if (error && !StatusOf(beside)) break;
      continue;
    }
    fs::rename(finished_, beside, error);
    if (!error) {
      placed_ = beside;
      break;
    }
    std::error_code ignored;
    fs::remove(beside, ignored);
  }
  SyncFolder(name.parent_path());
  if (!complete_) return;
  throw OutputError("output folder " + folder_.string() +
                    " cannot be put in place: " + reason +
                    "; the finished results are in " + placed_->string());
}

/// Why `old` is not to be replaced, in words that follow its name; else "".
std::string Placement::Objection(const fs::path& old, bool complete) const {
  const std::optional<struct stat> status = StatusOf(old);
  if (replaced_ && (!status || status->st_ino != replaced_->st_ino ||
                    status->st_dev != replaced_->st_dev)) {
    return "is not the one that was there at the start";
  }
  try {
    if (FolderEntries(old).empty()) return "";
    if (!force_) return "is no longer empty";
    const std::optional<ResultManifest> manifest = ReadManifest(old);
    if (!manifest) {
      return std::string("holds no ") + kManifestName + " of earlier results";
    }
    const std::string foreign = FindForeign(old);
    if (!foreign.empty()) return "holds " + foreign;
    if (!complete && manifest->complete) return "holds complete results";
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void Placement::Replace() {
  std::string objection = Objection(folder_, complete_);
  if (!objection.empty()) {
    PlaceBeside("it " + objection);
    return;
  }
  const std::error_code error = ExchangeFolders(finished_, folder_);
  if (error == std::errc::operation_not_supported) {
    ReplaceByTwoRenames();
    return;
  }
  if (error) {
    PlaceBeside(error.message());
    return;
  }
  // Another folder may have got the name just before.
  objection = Objection(finished_, complete_);
  if (objection.empty()) {
    TakenFrom(finished_);
  } else if (!ExchangeFolders(finished_, folder_)) {
    PlaceBeside("it " + objection);
  } else {
    placed_ = folder_;
    PrintNote("what " + folder_.string() + " held is in " + finished_.string());
  }
}

void Placement::ReplaceByTwoRenames() {
  const fs::path old = UnpublishedName(folder_);
  std::error_code error;
  fs::rename(folder_, old, error);
  if (!error) {
    const std::string objection = Objection(old, complete_);
    if (objection.empty()) {
      fs::rename(finished_, folder_, error);
      if (!error) {
        TakenFrom(old);
        return;
      }
    }
    std::error_code stays;
    fs::rename(old, folder_, stays);
    if (stays) {
      PrintNote("what " + folder_.string() + " held is in " + old.string());
    }
    if (!objection.empty()) {
      PlaceBeside("it " + objection);
      return;
    }
  }
  PlaceBeside(error.message());
}

}  // namespace hindsight
