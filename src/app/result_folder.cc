#include "app/result_folder.h"

#include <algorithm>
#include <system_error>

#include "app/error_line.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "io/output_error.h"
#include "io/paths.h"
#include "io/result_manifest.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

/// `folder` absolute, without links and without a trailing slash, so that what
/// is made beside it lies on the same file system.
fs::path Resolved(const std::string& folder) {
  fs::path path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  std::error_code refused;
  const fs::path resolved = fs::weakly_canonical(path, refused);
  return refused ? path : resolved;
}

std::optional<struct stat> StatusOf(const fs::path& path) {
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

bool LiesIn(const fs::path& input, const fs::path& folder) {
  std::error_code refused;
  fs::path path = fs::weakly_canonical(fs::absolute(input), refused);
  while (!refused) {
    if (fs::equivalent(path, folder, refused)) return true;
    if (path == path.parent_path()) return false;
    refused.clear();
    path = path.parent_path();
  }
  return false;
}

/// Complete results that never got their name, or had it before.
bool HoldsCompleteResults(const fs::path& folder) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  return manifest && manifest->complete &&
         std::all_of(
             manifest->files.begin(), manifest->files.end(),
             [&](const std::string& name) { return IsFile(folder / name); });
}

/// A file, or a folder of files; false if it is still there.
bool RemoveAbandoned(const fs::path& path) {
  std::error_code refused;
  if (fs::is_directory(fs::symlink_status(path, refused))) {
    for (const fs::path& entry : FolderEntries(path)) {
      if (fs::is_directory(fs::symlink_status(entry, refused))) return false;
      fs::remove(entry, refused);
    }
  }
  return fs::remove(path, refused);
}

bool IsFaultOfMedium(const std::error_code& error) {
  for (const std::errc cause :
       {std::errc::no_space_on_device, std::errc::io_error,
        std::errc::too_many_files_open,
        std::errc::too_many_files_open_in_system,
        std::errc::not_enough_memory}) {
    if (error == cause) return true;
  }
  return false;
}

}  // namespace

void TreatAbandoned(const fs::path& target, bool clean) {
  for (const fs::path& path : FindAbandoned(target)) {
    if (HoldsCompleteResults(path)) {
      PrintNote(path.string() +
                " holds complete results that a killed run did not put in "
                "place or replaced; rename or remove it");
    } else if (!clean) {
      PrintNote(path.string() + " is left of a killed run; --clean removes it");
    } else if (!RemoveAbandoned(path)) {
      PrintNote(path.string() + " cannot be removed");
    }
  }
}

ResultFolder::ResultFolder(const OutputRequest& request,
                           const std::function<Paths()>& inputs)
    : folder_(Resolved(request.folder)),
      stop_watch_([this] { return Stop(); }) {
  const std::lock_guard lock(mutex_);
  replaced_ = CheckMayReplace(request.force, inputs);
  TreatAbandoned(folder_, request.clean);
  MakeStaging();
}

ResultFolder::~ResultFolder() {
  const bool tells = !published_ && kept_;
  const std::string words = Abandon();
  if (tells) PrintNote(words);
}

std::optional<struct stat> ResultFolder::CheckMayReplace(
    bool force, const std::function<Paths()>& inputs) const {
  const std::optional<struct stat> status = StatusOf(folder_);
  if (!status) return std::nullopt;
  const std::string name = "output folder " + folder_.string();
  if (!S_ISDIR(status->st_mode)) {
    throw InputError("output " + folder_.string() + " exists and is no folder");
  }
  for (const fs::path& input : inputs()) {
    if (!LiesIn(input, folder_)) continue;
    throw InputError(name + " holds " + input.string() +
                     ", which is read; choose another");
  }
  const std::optional<struct stat> parent = StatusOf(folder_.parent_path());
  if (parent && parent->st_dev != status->st_dev) {
    throw InputError(name +
                     " is a mount point, which cannot be put in place in one "
                     "step; choose a folder in it");
  }
  if (FolderEntries(folder_).empty()) return status;
  if (!force) {
    throw InputError(name +
                     " exists; choose another or replace it with --force");
  }
  const std::string objection = Objection(folder_, true);
  if (objection.empty()) return status;
  throw InputError(name + " " + objection + "; --force does not replace it");
}

void ResultFolder::MakeStaging() {
  std::error_code error;
  // Making the temporary folder is the one reliable test of being allowed to.
  staging_ = CreateUnpublishedFolder(folder_, &error);
  finished_ = staging_.path;
  if (!error) return;
  const std::string message =
      "output folder " + folder_.string() +
      " cannot be written: " + folder_.parent_path().string() + ": " +
      error.message();
  if (IsFaultOfMedium(error)) throw OutputError(message);
  throw InputError(message);
}

std::string ResultFolder::Path(const std::string& name) const {
  return (staging_.path / name).string();
}

std::vector<std::string> ResultFolder::Written() const {
  std::vector<std::string> files;
  for (const fs::path& entry : FolderEntries(finished_)) {
    if (entry.filename() != kManifestName) files.push_back(entry.filename());
  }
  return files;
}

void ResultFolder::Keep(const std::string& name, const std::string& text) {
  const std::lock_guard lock(mutex_);
  half_kept_ = true;
  WriteFileAtomically(Path(name), text);
  Kept kept = {name, text, Written()};
  WriteManifest({.complete = false, .files = kept.files}, finished_);
  kept_ = std::move(kept);
  half_kept_ = false;
}

void ResultFolder::Commit(const std::string& name, const std::string& text) {
  const std::lock_guard lock(mutex_);
  half_kept_ = true;
  WriteFileAtomically(Path(name), text);
  PublishComplete();
}

void ResultFolder::Commit() {
  const std::lock_guard lock(mutex_);
  half_kept_ = true;
  PublishComplete();
}

void ResultFolder::PublishComplete() {
  WriteManifest({.complete = true, .files = Written()}, finished_);
  Publish(true);
}

void ResultFolder::Publish(bool complete) {
  if (const std::error_code error = SyncFolder(finished_)) {
    throw OutputError("output folder " + finished_.string() +
                      " cannot be written: " + error.message());
  }
  if (replaced_ && StatusOf(folder_)) {
    Replace(complete);
    return;
  }
  std::error_code error;
  fs::rename(finished_, folder_, error);
  if (error) {
    PublishBeside(complete, error.message());
    return;
  }
  ReplacedBy("");
}

void ResultFolder::ReplacedBy(const fs::path& old) {
  published_ = folder_;
  if (const std::error_code error = SyncFolder(folder_.parent_path())) {
    throw OutputError(
        "output folder " + folder_.string() +
        " is in place, but may be lost with the power: " + error.message());
  }
  if (old.empty() || RemoveListed(old)) return;
  PrintNote("what " + folder_.string() + " held is left in " + old.string());
}

void ResultFolder::PublishBeside(bool complete, const std::string& reason) {
  published_ = finished_;
  for (int i = 1; i < 10000; ++i) {
    const fs::path beside = folder_.string() + "." + std::to_string(i);
    std::error_code error;
    if (StatusOf(beside) || !fs::create_directory(beside, error)) {
      if (error && !StatusOf(beside)) break;
      continue;
    }
    fs::rename(finished_, beside, error);
    if (!error) {
      published_ = beside;
      break;
    }
    std::error_code ignored;
    fs::remove(beside, ignored);
  }
  SyncFolder(folder_.parent_path());
  if (!complete) return;
  throw OutputError("output folder " + folder_.string() +
                    " cannot be put in place: " + reason +
                    "; the finished results are in " + published_->string());
}

std::string ResultFolder::Objection(const fs::path& old, bool complete) const {
  const std::optional<struct stat> status = StatusOf(old);
  if (replaced_ && (!status || status->st_ino != replaced_->st_ino ||
                    status->st_dev != replaced_->st_dev)) {
    return "is not the one that was there at the start";
  }
  try {
    if (FolderEntries(old).empty()) return "";
    const std::optional<ResultManifest> manifest = ReadManifest(old);
    if (!manifest) {
      return std::string("holds no ") + kManifestName + " of earlier results";
    }
    const std::string unlisted = FindUnlisted(old);
    if (!unlisted.empty()) {
      return "holds " + unlisted + ", which is not listed in its " +
             kManifestName;
    }
    if (!complete && manifest->complete) return "holds complete results";
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void ResultFolder::Replace(bool complete) {
  std::string objection = Objection(folder_, complete);
  if (!objection.empty()) {
    PublishBeside(complete, "it " + objection);
    return;
  }
  const std::error_code error = ExchangeFolders(finished_, folder_);
  if (error == std::errc::operation_not_supported) {
    ReplaceByTwoRenames(complete);
    return;
  }
  if (error) {
    PublishBeside(complete, error.message());
    return;
  }
  // Another folder may have got the name just before.
  objection = Objection(finished_, complete);
  if (objection.empty()) {
    ReplacedBy(finished_);
  } else if (!ExchangeFolders(finished_, folder_)) {
    PublishBeside(complete, "it " + objection);
  } else {
    published_ = folder_;
    PrintNote("what " + folder_.string() + " held is in " + finished_.string());
  }
}

void ResultFolder::ReplaceByTwoRenames(bool complete) {
  const fs::path old = UnpublishedName(folder_);
  std::error_code error;
  fs::rename(folder_, old, error);
  if (!error) {
    const std::string objection = Objection(old, complete);
    if (objection.empty()) {
      fs::rename(finished_, folder_, error);
      if (!error) {
        ReplacedBy(old);
        return;
      }
    }
    std::error_code stays;
    fs::rename(old, folder_, stays);
    if (stays) {
      PrintNote("what " + folder_.string() + " held is in " + old.string());
    }
    if (!objection.empty()) {
      PublishBeside(complete, "it " + objection);
      return;
    }
  }
  PublishBeside(complete, error.message());
}

void ResultFolder::RestoreKept() {
  for (const std::string& name : Written()) {
    if (std::find(kept_->files.begin(), kept_->files.end(), name) ==
        kept_->files.end()) {
      fs::remove(finished_ / name);
    }
  }
  if (!half_kept_) return;
  WriteFileAtomically((finished_ / kept_->name).string(), kept_->text);
  WriteManifest({.complete = false, .files = kept_->files}, finished_);
}

std::string ResultFolder::AbandonLocked() {
  if (published_ || finished_.empty()) return "";
  // Nothing that is still being written reaches it there.
  const fs::path aside = UnpublishedName(folder_);
  std::error_code refused;
  fs::rename(finished_, aside, refused);
  if (!refused) finished_ = aside;
  std::string cause;
  if (kept_) {
    try {
      RestoreKept();
      Publish(false);
    } catch (const std::exception& error) {
      cause = std::string(": ") + error.what();
    }
  }
  if (published_) {
    return "what was finished is in " + published_->string() + ", whose " +
           kept_->name + " says complete: false" + cause;
  }
  fs::remove_all(finished_, refused);
  finished_.clear();
  return (kept_ ? "nothing is left" : "nothing was finished, nothing is left") +
         cause;
}

std::string ResultFolder::Abandon() {
  const std::lock_guard lock(mutex_);
  return AbandonLocked();
}

std::string ResultFolder::Stop() {
  // For good: who waits for it from now on waits for the end of the process.
  mutex_.lock();
  if (published_)
    return "interrupted; the results are in " + published_->string();
  const std::string words = AbandonLocked();
  return words.empty() ? "interrupted" : "interrupted; " + words;
}

int WithResultFolder(const OutputRequest& request,
                     const std::function<ResultFolder::Paths()>& inputs,
                     const std::function<int(ResultFolder*)>& work) {
  ResultFolder folder(request, inputs);
  try {
    return work(&folder);
  } catch (const OutputError& error) {
    const std::string words = folder.Abandon();
    throw OutputError(error.what() + (words.empty() ? "" : "; " + words));
  }
}

}  // namespace hindsight
