#include "base/scratch_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>
#include <utility>

namespace hindsight {
namespace {

/// An open file without a name, -1 if there can be none.
int OpenScratchFile() {
  const char* set = std::getenv("TMPDIR");
  // /tmp itself is memory on many systems.
  const std::string folder = set != nullptr && *set != '\0' ? set : "/var/tmp";
  const int unnamed =
      open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (unnamed >= 0) return unnamed;
  std::string path = folder + "/hindsight-XXXXXX";
  const int named = mkostemp(path.data(), O_CLOEXEC);
  if (named >= 0) unlink(path.c_str());
  return named;
}

/// Maps a file; nullptr if that cannot be. Its place on the disk is taken at once: a
/// disk that is full later would end the process.
std::byte* MapFile(std::size_t bytes) {
  const int file = OpenScratchFile();
  if (file < 0) return nullptr;
  void* data = MAP_FAILED;
  if (fallocate(file, 0, 0, static_cast<off_t>(bytes)) == 0) {
    data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  }
  close(file);
  return data == MAP_FAILED ? nullptr : static_cast<std::byte*>(data);
}

}  // namespace

ScratchMemory::ScratchMemory(std::size_t bytes, std::size_t block)
    : bytes_(bytes), block_(block) {
  const std::size_t blocks = (bytes + block - 1) / block;
  held_ = std::make_unique<std::atomic<char>[]>(blocks);
  if (bytes >= kSmallest) data_ = MapFile(bytes);
  if (data_ != nullptr) {
    lock_ = std::make_unique<std::mutex>();
    return;
  }
  data_ =
      static_cast<std::byte*>(std::calloc(std::max<std::size_t>(bytes, 1), 1));
  if (data_ == nullptr) throw std::bad_alloc();
  for (std::size_t i = 0; i < blocks; ++i) held_[i] = kWritten;
}

ScratchMemory::~ScratchMemory() {
  if (is_file()) {
    munmap(data_, bytes_);
  } else {
    std::free(data_);
  }
}

void ScratchMemory::swap(ScratchMemory& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  std::swap(block_, other.block_);
  held_.swap(other.held_);
  std::swap(held_count_, other.held_count_);
  lock_.swap(other.lock_);
}

void ScratchMemory::Hold(std::size_t block, char how) const {
  const std::lock_guard<std::mutex> guard(*lock_);
  if (held_[block] >= how) return;
  if (held_[block] == 0 && ++held_count_ > kMostHeld) {
    // Another thread that is reading meanwhile finds the same bytes.
    madvise(data_, bytes_, MADV_DONTNEED);
    for (std::size_t i = 0; i * block_ < bytes_; ++i) held_[i] = 0;
    held_count_ = 1;
  }
  // In one call, many times as fast as page by page when they are touched. Where
  // the system does not know the advice, they come when they are touched.
  madvise(data_ + block * block_, std::min(block_, bytes_ - block * block_),
          how == kRead ? MADV_POPULATE_READ : MADV_POPULATE_WRITE);
  held_[block].store(how, std::memory_order_relaxed);
}

}  // namespace hindsight
