#ifndef HINDSIGHT_BASE_SCRATCH_MEMORY_H_
#define HINDSIGHT_BASE_SCRATCH_MEMORY_H_

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>

namespace hindsight {

/// Memory for what is too large to be held and read seldom. If it is large, it is
/// mapped from a temporary file, which no folder lists and which ends with the
/// object, and of its blocks the process holds the few that were touched last; the
/// others are the system's, which keeps them in its cache of files for as long as
/// nobody needs that memory, and on disk otherwise. The file is in $TMPDIR, or in
/// /var/tmp. What is small is plain memory, and so is all where no file can be had.
/// All bytes are zero at first.
class ScratchMemory {
 public:
  /// Below this it is plain memory [bytes].
  static constexpr std::size_t kSmallest = std::size_t{1} << 26;
  /// Blocks of a file that are held at once, by all threads together.
  static constexpr std::size_t kMostHeld = 8;

  ScratchMemory() = default;
  /// `block` [bytes] must be a multiple of 4096. Throws std::bad_alloc.
  ScratchMemory(std::size_t bytes, std::size_t block);
  ScratchMemory(ScratchMemory&& other) noexcept { swap(other); }
  ScratchMemory& operator=(ScratchMemory&& other) noexcept {
    ScratchMemory(std::move(other)).swap(*this);
    return *this;
  }
  ~ScratchMemory();
  void swap(ScratchMemory& other) noexcept;

  std::byte* data() const { return data_; }
  /// Whether a file is behind it.
  bool is_file() const { return lock_ != nullptr; }

  /// To be called before bytes of a block are read or written, by any thread.
  /// Without it they are the same, but held for longer.
  void BeforeReading(std::size_t block) const {
    if (held_[block].load(std::memory_order_relaxed) == 0) Hold(block, kRead);
  }
  void BeforeWriting(std::size_t block) {
    if (held_[block].load(std::memory_order_relaxed) != kWritten) {
      Hold(block, kWritten);
    }
  }
  /// Blocks that the process holds of a file.
  std::size_t held() const { return is_file() ? held_count_ : 0; }

 private:
  static constexpr char kRead = 1;
  static constexpr char kWritten = 2;

  void Hold(std::size_t block, char how) const;

  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t block_ = 1;
  std::unique_ptr<std::atomic<char>[]> held_;  ///< how, one a block
  mutable std::size_t held_count_ = 0;
  std::unique_ptr<std::mutex> lock_;  ///< null: plain memory
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_SCRATCH_MEMORY_H_
