#include "app/result_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/abandoned.h"
#include "app/error_line.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/write/atomic_file.h"
#include "io/write/output_error.h"
#include "io/write/result_manifest.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

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

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

ResultFolder::ResultFolder(const OutputRequest& request,
                           const std::function<Paths()>& inputs)
    : placement_(request, inputs), stop_watch_([this] { return Stop(); }) {
  const std::lock_guard lock(mutex_);
  TreatAbandoned(placement_.folder(), request.clean, DisownedFolder);
  MakeStaging();
}

ResultFolder::~ResultFolder() {
  const bool tells = !placement_.placed() && (kept_ || at_end_);
  const std::string words = Abandon();
  if ((tells || is_left_) && !words.empty()) PrintNote(words);
}

void ResultFolder::MakeStaging() {
  std::error_code error;
  const fs::path& folder = placement_.folder();
  // Making the temporary folder is the one reliable test of being allowed to.
  staging_ = CreateUnpublishedFolder(folder, &error);
  finished_ = staging_.path;
  if (!error) return;
  const std::string message =
      "output folder " + folder.string() +
      " cannot be written: " + folder.parent_path().string() + ": " +
      error.message();
  if (IsFaultOfMedium(error)) throw OutputError(message);
  throw InputError(message);
}

void ResultFolder::List(const std::string& name) {
  if (Has(listed_, name)) return;
  std::vector<std::string> files = listed_;
  files.push_back(name);
  WriteManifest({.complete = false, .files = files}, finished_);
  listed_ = std::move(files);
}

std::string ResultFolder::Path(const std::string& name) {
  const std::lock_guard lock(mutex_);
  List(name);
  return (finished_ / name).string();
}

void ResultFolder::Write(const OutputFile& file) {
  WriteFileAtomically(Path(file.name), file.text);
}

/// Those of the files listed that are there, sorted.
std::vector<std::string> ResultFolder::Written() const {
  std::vector<std::string> files = listed_;
  std::erase_if(files, [this](const std::string& name) {
    std::error_code refused;
    return fs::symlink_status(finished_ / name, refused).type() ==
           fs::file_type::not_found;
  });
  std::sort(files.begin(), files.end());
  return files;
}

void ResultFolder::Keep(const std::string& name, const std::string& text) {
  const std::lock_guard lock(mutex_);
  List(name);
  half_kept_ = true;
  WriteFileAtomically((finished_ / name).string(), text);
  kept_ = {{name, text}, Written()};
  half_kept_ = false;
}

void ResultFolder::WaitFor(std::shared_future<void> writing) {
  const std::lock_guard lock(mutex_);
  writing_ = std::move(writing);
}

void ResultFolder::KeepAtEnd(
    std::function<std::vector<OutputFile>()> finished) {
  const std::lock_guard lock(mutex_);
  at_end_ = std::move(finished);
}

void ResultFolder::Commit(const std::string& name, const std::string& text) {
  const std::lock_guard lock(mutex_);
  List(name);
  half_kept_ = true;
  WriteFileAtomically((finished_ / name).string(), text);
  CommitLocked();
}

void ResultFolder::Commit() {
  const std::lock_guard lock(mutex_);
  CommitLocked();
}

void ResultFolder::CommitLocked() {
  half_kept_ = true;
  WriteManifest({.complete = true, .files = Written()}, finished_);
  placement_.Place(finished_, true);
}

void ResultFolder::RestoreKept() {
  for (const std::string& name : Written()) {
    if (!Has(kept_->files, name)) fs::remove(finished_ / name);
  }
  const ResultManifest manifest = {.complete = false, .files = kept_->files};
  if (half_kept_) {
    WriteFileAtomically((finished_ / kept_->file.name).string(),
                        kept_->file.text);
    WriteManifest(manifest, finished_);
    return;
  }
  try {
    WriteManifest(manifest, finished_);
  } catch (const OutputError&) {
    // That on the medium lists all of them, and files that are not there.
  }
}

void ResultFolder::KeepFinished(const std::vector<OutputFile>& files) {
  for (const std::string& name : Written()) fs::remove(finished_ / name);
  std::vector<std::string> names;
  for (const OutputFile& file : files) names.push_back(file.name);
  WriteManifest({.complete = false, .files = names}, finished_);
  WriteFileAtomically((finished_ / files.front().name).string(),
                      files.front().text);
  kept_ = {files.front(), names};
  half_kept_ = false;
  for (std::size_t i = 1; i < files.size(); ++i) {
    WriteFileAtomically((finished_ / files[i].name).string(), files[i].text);
  }
}

/// So that nothing that is still being written reaches it. It may lie elsewhere
/// than it was made.
void ResultFolder::SetAside() {
  if (const auto present = PresentPath(staging_)) finished_ = *present;
  const fs::path aside =
      finished_.parent_path() / UnpublishedName(placement_.folder()).filename();
  std::error_code refused;
  fs::rename(finished_, aside, refused);
  if (!refused) finished_ = aside;
}

/// Removes what a file of the folder is being written to, which will not get its
/// name any more.
void ResultFolder::RemoveUnpublished() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(finished_)) {
    const std::string name = entry.path().filename().string();
    const bool is_one = std::any_of(listed_.begin(), listed_.end(),
                                    [&name](const std::string& target) {
                                      return IsUnpublishedName(name, target);
                                    });
    if (is_one) found.push_back(entry.path());
  }
  for (const fs::path& path : found) fs::remove(path);
}

/// Whether something was finished; `cause` says why not all of it is kept.
bool ResultFolder::KeepWhatIsFinished(std::string* cause) {
  bool has_finished = kept_.has_value();
  try {
    const std::vector<OutputFile> files =
        at_end_ ? at_end_() : std::vector<OutputFile>();
    has_finished = has_finished || !files.empty();
    if (!files.empty()) KeepFinished(files);
  } catch (const std::exception& error) {
    *cause = ": " + Explain(error);
  }
  try {
    if (kept_) {
      RestoreKept();
      RemoveUnpublished();
      placement_.Place(finished_, false);
    }
  } catch (const std::exception& error) {
    *cause = ": " + Explain(error);
  }
  return has_finished;
}

/// Removes what was written. What stays, in words that follow "nothing is
/// left".
std::string ResultFolder::RemoveStaging() {
  staging_.descriptor = Descriptor();  // listing the folder takes one
  const fs::path folder = std::exchange(finished_, fs::path());
  std::error_code refused;
  if (fs::symlink_status(folder, refused).type() == fs::file_type::not_found) {
    return " (others removed or moved " + folder.string() + ")";
  }
  std::string foreign;
  try {
    foreign = FindForeign(folder, Finished::kNo);
  } catch (const InputError&) {
    // It cannot be listed, or not now.
  }
  try {
    if (RemoveUnfinished(folder)) return "";
  } catch (const InputError&) {
    // It stays as it is.
  }
  is_left_ = true;
  return " but " + folder.string() +
         (foreign.empty() ? ", which cannot be removed"
                          : ", which holds " + foreign);
}

std::string ResultFolder::AbandonLocked() {
  if (placement_.placed() || finished_.empty()) return "";
  SetAside();
  std::string cause;
  const bool has_finished = KeepWhatIsFinished(&cause);
  if (placement_.placed()) {
    return "what was finished is in " + placement_.placed()->string() +
           ", whose " + kept_->file.name + " says complete: false" + cause;
  }
  return (has_finished ? "nothing is left"
                       : "nothing was finished, nothing is left") +
         RemoveStaging() + cause;
}

std::string ResultFolder::Explain(const std::exception& error) const {
  const auto* output = dynamic_cast<const OutputError*>(&error);
  if (output == nullptr) return error.what();
  const fs::path written_in = output->file().parent_path().filename();
  const fs::path& folder = placement_.folder();
  if (!IsUnpublishedName(written_in.string(), folder)) return error.what();
  return OutputError(folder / output->file().filename(), output->cause())
      .what();
}

std::string ResultFolder::Abandon() {
  const std::lock_guard lock(mutex_);
  return AbandonLocked();
}

std::string ResultFolder::Stop() {
  std::shared_future<void> writing;
  {
    const std::lock_guard lock(mutex_);
    writing = writing_;
  }
  if (writing.valid()) writing.wait();
  // For good: who waits for it from now on waits for the end of the process.
  mutex_.lock();
  if (placement_.placed()) {
    return "interrupted; the results are in " + placement_.placed()->string();
  }
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
    throw OutputError(folder.Explain(error) +
                      (words.empty() ? "" : "; " + words));
  }
}

}  // namespace hindsight
