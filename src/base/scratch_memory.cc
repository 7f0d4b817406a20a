#include "base/scratch_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "base/file_piece.h"
#include "base/scratch_file.h"

namespace hindsight {
namespace {

/// Blocks of a memory that are filled at once: what lies across the end of one, or is
/// written together with a row beside it, touches two.
constexpr std::size_t kFilledAtOnce = 2;

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
    zero_at_first = at_first == AtFirst::kZero;
    if (!all_zero && zero_at_first) {
      to_clear.assign((bytes + block - 1) / block, true);
    }
    void* place = mmap(nullptr, Size(), PROT_NONE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) return;
    data = static_cast<std::byte*>(place);
    if (MapFile(0, Size())) return;
    munmap(data, Size());
    data = nullptr;
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping();
  std::size_t Size() const { return extents.size() * ScratchFile::kExtent; }
  std::size_t SizeOf(std::size_t number) const {
    return std::min(block, Size() - number * block);
  }
  std::byte* At(std::size_t number) const { return data + number * block; }
  /// Lets blocks go, from one to another. Another thread that is reading meanwhile
  /// finds the same bytes.
  void Release(std::size_t first, std::size_t last) {
    const auto size = static_cast<std::size_t>(At(last) - At(first));
    madvise(At(first), size + SizeOf(last), MADV_DONTNEED);
    for (std::size_t i = first; i <= last; ++i) held[i] = kLetGo;
  }
  /// Makes a block plain memory: of pages of its own, or of those of the block that
  /// was first to be filled, which the system need not make again.
  void BeginFilling(std::size_t number) {
    if (filling.size() < kFilledAtOnce || !MovePages(number)) {
      EndFilling(kFilledAtOnce - 1);
      if (mmap(At(number), SizeOf(number), PROT_READ | PROT_WRITE,
               MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED) {
        throw std::bad_alloc();
      }
      madvise(At(number), SizeOf(number), MADV_POPULATE_WRITE);
    }
    filling.push_back(number);
  }
  /// Writes such blocks, but the last `kept`, to their places in the file, which
  /// takes the place of the plain memory. That remains if it cannot be written.
  void EndFilling(std::size_t kept) {
    while (filling.size() > kept) {
      const std::size_t number = filling.front();
      filling.erase(filling.begin());
      if (WriteFile(number * block, SizeOf(number))) ReturnToFile(number);
    }
  }

  std::size_t block;  ///< [bytes]
  std::shared_ptr<ScratchFile> file;
  std::vector<std::size_t> extents;
  std::byte* data = nullptr;
  std::vector<bool> to_clear;  ///< blocks; none: all are as they should be
  std::vector<std::size_t> filling;  ///< blocks that are plain memory
  bool zero_at_first = false;
  std::atomic<char>* held = nullptr;

 private:
  /// Writes the block that was first to be filled to its place in the file, and
  /// makes another of its pages. False if that cannot be.
  bool MovePages(std::size_t number) {
    const std::size_t first = filling.front();
    const std::size_t size = SizeOf(first);
    if (SizeOf(number) != size || !WriteFile(first * block, size)) return false;
    if (mremap(At(first), size, size, MREMAP_MAYMOVE | MREMAP_FIXED,
               At(number)) == MAP_FAILED) {
      return false;
    }
    filling.erase(filling.begin());
    ReturnToFile(first);
    if (zero_at_first) std::memset(At(number), 0, size);
    return true;
  }
  void ReturnToFile(std::size_t number) {
    if (!MapFile(number * block, SizeOf(number))) throw std::bad_alloc();
    held[number] = kLetGo;
  }

  /// Calls use(begin, size, offset in the file) for the parts of a range that lie
  /// side by side in the file, until one is false. Whether all are true.
  template <typename Use>
  bool AllParts(std::size_t begin, std::size_t size, const Use& use) const {
    constexpr std::size_t kExtent = ScratchFile::kExtent;
    for (const std::size_t end = begin + size; begin < end;) {
      std::size_t i = begin / kExtent;
      const std::size_t place = extents[i] * kExtent + begin % kExtent;
      for (++i; i * kExtent < end && extents[i] == extents[i - 1] + 1;) ++i;
      const std::size_t to = std::min(end, i * kExtent);
      if (!use(begin, to - begin, static_cast<off_t>(place))) return false;
      begin = to;
    }
    return true;
  }
  bool MapFile(std::size_t begin, std::size_t size) {
    return AllParts(begin, size,
                    [this](std::size_t at, std::size_t count, off_t place) {
                      return mmap(data + at, count, PROT_READ | PROT_WRITE,
                                  MAP_SHARED | MAP_FIXED, file->descriptor(),
                                  place) != MAP_FAILED;
                    });
  }
  bool WriteFile(std::size_t begin, std::size_t size) const {
    return AllParts(
        begin, size, [this](std::size_t at, std::size_t count, off_t place) {
          while (count > 0) {
            const ssize_t done = pwrite(file->descriptor(), data + at,
                                        std::min(count, kFilePiece), place);
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            at += static_cast<std::size_t>(done);
            count -= static_cast<std::size_t>(done);
            place += done;
          }
          return true;
        });
  }
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
    if (bytes_ + bytes > kMostHeld) LetOldestGo();
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

  /// The older half. Those side by side go by one call: with each, the system makes
  /// the other processors forget what they know of the process' memory.
  static void LetOldestGo() {
    auto end = all_.begin();
    while (end != all_.end() && bytes_ > kMostHeld / 2)
      bytes_ -= (end++)->bytes;
    std::sort(all_.begin(), end, [](const Held& a, const Held& b) {
      return std::pair(a.mapping, a.number) < std::pair(b.mapping, b.number);
    });
    for (auto first = all_.begin(); first != end;) {
      auto last = first;
      auto next = first + 1;
      while (next != end && next->mapping == first->mapping &&
             next->number == last->number + 1) {
        last = next++;
      }
      first->mapping->Release(first->number, last->number);
      first = next;
    }
    all_.erase(all_.begin(), end);
  }

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
  const std::size_t size = std::max<std::size_t>(bytes, 1);
  data_ = static_cast<std::byte*>(
      at_first == AtFirst::kZero ? std::calloc(size, 1) : std::malloc(size));
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
  if (how == kWritten) Fill(block);
  const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
  if (held_[block] >= how) return;
  std::byte* begin = data_ + block * block_;
  const std::size_t size = std::min(block_, bytes_ - block * block_);
  if (held_[block] < kRead) HeldBlocks::Add(mapping_.get(), block, size);
  const bool clear = !mapping_->to_clear.empty() && mapping_->to_clear[block];
  // To be written, pages come in one call faster than when they are touched; to be
  // read, slower, as touching one maps those beside it. Where the system does not
  // know the advice, they come when they are touched.
  if (how == kWritten || clear) madvise(begin, size, MADV_POPULATE_WRITE);
  if (clear) {
    std::memset(begin, 0, size);
    mapping_->to_clear[block] = false;
  }
  held_[block].store(how, std::memory_order_relaxed);
}

/// If nobody has touched it.
void ScratchMemory::Fill(std::size_t block) const {
  {
    const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
    if (held_[block] != kUntouched) return;
    held_[block] = kWritten;
    if (!mapping_->to_clear.empty()) mapping_->to_clear[block] = false;
  }
  mapping_->BeginFilling(block);
}

void ScratchMemory::EndFilling() {
  if (mapping_ != nullptr) mapping_->EndFilling(0);
}

std::size_t ScratchMemory::held() {
  const std::lock_guard<std::mutex> guard(HeldBlocks::Mutex());
  return HeldBlocks::Bytes();
}

}  // namespace hindsight
