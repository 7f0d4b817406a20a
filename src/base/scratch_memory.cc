#include "base/scratch_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

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

/// A file that grows by extents, of which those that are given back are handed out
/// again: their pages are there already, where the system clears each new one.
class ScratchFile {
 public:
  static constexpr std::size_t kExtent = ScratchMemory::kSmallest / 4;

  /// The one that memories of this process share, nullptr if there can be none.
  static std::shared_ptr<ScratchFile> Shared();

  explicit ScratchFile(std::string folder)
      : folder_(std::move(folder)), file_(OpenScratchFile(folder_)) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    if (file_ >= 0) close(file_);
  }

  int descriptor() const { return file_; }

  /// Numbers of extents in ascending order, none if the disk has no room for them.
  /// Their place on the disk is taken at once: a disk that is full later would end
  /// the process. `all_zero` says that nothing was written to any of them.
  std::vector<std::size_t> Take(std::size_t count, bool* all_zero) {
    const std::lock_guard<std::mutex> guard(mutex_);
    *all_zero = free_.empty();
    if (count > free_.size() && !Grow(count - free_.size())) return {};
    const auto first = free_.end() - static_cast<std::ptrdiff_t>(count);
    std::vector<std::size_t> taken(first, free_.end());
    free_.erase(first, free_.end());
    std::sort(taken.begin(), taken.end());
    return taken;
  }
  void GiveBack(const std::vector<std::size_t>& extents) {
    const std::lock_guard<std::mutex> guard(mutex_);
    free_.insert(free_.end(), extents.begin(), extents.end());
  }

 private:
  bool Grow(std::size_t count) {
    if (fallocate(file_, 0, static_cast<off_t>(size_ * kExtent),
                  static_cast<off_t>(count * kExtent)) != 0) {
      return false;
    }
    for (; count > 0; --count) free_.insert(free_.begin(), size_++);
    return true;
  }

  std::string folder_;
  int file_;
  std::mutex mutex_;
  std::size_t size_ = 0;           ///< [extents]
  std::vector<std::size_t> free_;  ///< the last ones go first
};

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

}  // namespace

/// Extents of the file, one behind the other in memory.
struct ScratchMemory::Mapping {
  /// `data` is nullptr where that cannot be.
  Mapping(std::size_t bytes, std::size_t block_bytes, AtFirst at_first)
      : block(block_bytes), file(ScratchFile::Shared()) {
    constexpr std::size_t kExtent = ScratchFile::kExtent;
    if (file == nullptr) return;
    bool all_zero = false;
    extents = file->Take((bytes + kExtent - 1) / kExtent, &all_zero);
    if (extents.empty()) return;
    if (!all_zero && at_first == AtFirst::kZero) {
      to_clear.assign((bytes + block - 1) / block, true);
    }
    void* place = mmap(nullptr, Size(), PROT_NONE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) return;
    data = static_cast<std::byte*>(place);
    for (std::size_t i = 0, next = 0; i < extents.size(); i = next) {
      for (next = i + 1; next < extents.size(); ++next) {
        if (extents[next] != extents[next - 1] + 1) break;
      }
      if (mmap(data + i * kExtent, (next - i) * kExtent, PROT_READ | PROT_WRITE,
               MAP_SHARED | MAP_FIXED, file->descriptor(),
               static_cast<off_t>(extents[i] * kExtent)) == MAP_FAILED) {
        munmap(data, Size());
        data = nullptr;
        return;
      }
    }
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping();
  std::size_t Size() const { return extents.size() * ScratchFile::kExtent; }
  /// Lets a block go. Another thread that is reading meanwhile finds the same
  /// bytes.
  void Release(std::size_t number) {
    const std::size_t begin = number * block;
    madvise(data + begin, std::min(block, Size() - begin), MADV_DONTNEED);
    held[number] = 0;
  }

  std::size_t block;  ///< [bytes]
  std::shared_ptr<ScratchFile> file;
  std::vector<std::size_t> extents;
  std::byte* data = nullptr;
  std::vector<bool> to_clear;  ///< blocks; none: all are as they should be
  std::atomic<char>* held = nullptr;
};

/// The blocks that are held, in the order in which they were asked for. For use under
/// the mutex.
class ScratchMemory::HeldBlocks {
 public:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::size_t Bytes() { return bytes_; }

  /// Adds one, and lets others go where they are too many.
  static void Add(Mapping* mapping, std::size_t number, std::size_t bytes) {
    while (bytes_ + bytes > kMostHeld && !all_.empty()) {
      const Held& first = all_.front();
      first.mapping->Release(first.number);
      bytes_ -= first.bytes;
      all_.pop_front();
    }
    all_.push_back({mapping, number, bytes});
    bytes_ += bytes;
  }
  static void Forget(const Mapping* mapping) {
    std::erase_if(all_, [mapping](const Held& one) {
      if (one.mapping != mapping) return false;
      bytes_ -= one.bytes;
      return true;
    });
  }

 private:
  struct Held {
    Mapping* mapping;
    std::size_t number;
    std::size_t bytes;
  };

  static inline std::deque<Held> all_;
  static inline std::size_t bytes_ = 0;
};

ScratchMemory::Mapping::~Mapping() {
  if (data != nullptr) {
    const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
    HeldBlocks::Forget(this);
    munmap(data, Size());
  }
  if (file != nullptr) file->GiveBack(extents);
}

ScratchMemory::ScratchMemory() = default;

ScratchMemory::ScratchMemory(std::size_t bytes, std::size_t block,
                             AtFirst at_first)
    : bytes_(bytes), block_(block) {
  const std::size_t blocks = (bytes + block - 1) / block;
  held_ = std::make_unique<std::atomic<char>[]>(blocks);
  if (bytes >= kSmallest) {
    mapping_ = std::make_unique<Mapping>(bytes, block, at_first);
  }
  if (mapping_ != nullptr && mapping_->data != nullptr) {
    data_ = mapping_->data;
    mapping_->held = held_.get();
    return;
  }
  mapping_.reset();
  data_ =
      static_cast<std::byte*>(std::calloc(std::max<std::size_t>(bytes, 1), 1));
  if (data_ == nullptr) throw std::bad_alloc();
  for (std::size_t i = 0; i < blocks; ++i) held_[i] = kWritten;
}

ScratchMemory::ScratchMemory(ScratchMemory&& other) noexcept { swap(other); }

ScratchMemory::~ScratchMemory() {
  if (!is_file()) std::free(data_);
}

void ScratchMemory::swap(ScratchMemory& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  std::swap(block_, other.block_);
  held_.swap(other.held_);
  mapping_.swap(other.mapping_);
}

void ScratchMemory::Hold(std::size_t block, char how) const {
  const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
  if (held_[block] >= how) return;
  std::byte* begin = data_ + block * block_;
  const std::size_t size = std::min(block_, bytes_ - block * block_);
  if (held_[block] == 0) HeldBlocks::Add(mapping_.get(), block, size);
  const bool clear = !mapping_->to_clear.empty() && mapping_->to_clear[block];
  // In one call, many times as fast as page by page when they are touched. Where
  // the system does not know the advice, they come when they are touched.
  madvise(begin, size,
          how == kRead && !clear ? MADV_POPULATE_READ : MADV_POPULATE_WRITE);
  if (clear) {
    std::memset(begin, 0, size);
    mapping_->to_clear[block] = false;
  }
  held_[block].store(how, std::memory_order_relaxed);
}

std::size_t ScratchMemory::held() {
  const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
  return HeldBlocks::Bytes();
}

}  // namespace hindsight
