#include "base/scratch_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace hindsight {
namespace {

std::string ScratchFolder() {
  const char* set = std::getenv("TMPDIR");
  // /tmp itself is memory on many systems.
  return set != nullptr && *set != '\0' ? set : "/var/tmp";
}

/// An open file without a name, -1 if there can be none.
int OpenScratchFile(const std::string& folder) {
  const int unnamed =
      open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (unnamed >= 0) return unnamed;
  std::string path = folder + "/hindsight-XXXXXX";
  const int named = mkostemp(path.data(), O_CLOEXEC);
  if (named >= 0) unlink(path.c_str());
  return named;
}

}  // namespace

ScratchFile::ScratchFile(std::string folder)
    : folder_(std::move(folder)), file_(OpenScratchFile(folder_)) {}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) close(file_);
}

std::vector<std::size_t> ScratchFile::Take(std::size_t count, bool* all_zero) {
  const std::lock_guard<std::mutex> guard(mutex_);
  *all_zero = free_.empty();
  if (count > free_.size() && !Grow(count - free_.size())) return {};
  const auto first = free_.end() - static_cast<std::ptrdiff_t>(count);
  std::vector<std::size_t> taken(first, free_.end());
  free_.erase(first, free_.end());
  std::sort(taken.begin(), taken.end());
  return taken;
}

void ScratchFile::GiveBack(const std::vector<std::size_t>& extents) {
  const std::lock_guard<std::mutex> guard(mutex_);
  free_.insert(free_.end(), extents.begin(), extents.end());
}

bool ScratchFile::Grow(std::size_t count) {
  if (fallocate(file_, 0, static_cast<off_t>(size_ * kExtent),
                static_cast<off_t>(count * kExtent)) != 0) {
    return false;
  }
  for (; count > 0; --count) free_.insert(free_.begin(), size_++);
  return true;
}

std::shared_ptr<ScratchFile> ScratchFile::Shared() {
  static std::mutex mutex;
  static std::weak_ptr<ScratchFile> shared;
  const std::lock_guard<std::mutex> guard(mutex);
  std::shared_ptr<ScratchFile> file = shared.lock();
  const std::string folder = ScratchFolder();
  if (file == nullptr || file->folder_ != folder) {
    file = std::make_shared<ScratchFile>(folder);
    shared = file;
  }
  return file->descriptor() < 0 ? nullptr : file;
}

}  // namespace hindsight
