#ifndef HINDSIGHT_BASE_SCRATCH_MEMORY_H_
#define HINDSIGHT_BASE_SCRATCH_MEMORY_H_

#include <atomic>
#include <cstddef>
#include <memory>

namespace hindsight {

/// Memory for what is too large to be held and read seldom. If it is large, it is
/// mapped from a temporary file, which no folder lists, and of its blocks the process
/// holds the few that were touched last; the others are the system's, which keeps
/// them in its cache of files for as long as nobody needs that memory, and on disk
/// otherwise. The file is in $TMPDIR, or in /var/tmp; all large ones share it, the
/// place of one that has ended goes to the next, and it ends with the last of them.
/// What is small is plain memory, and so is all where no file can be had.
/// A block that nobody has touched is plain memory from when it is first written to
/// until two more such blocks are, and goes into the file as a whole then: a file's
/// page that comes by being touched costs the system twice as much.
class ScratchMemory {
 public:
  /// Below this it is plain memory [bytes].
  static constexpr std::size_t kSmallest = std::size_t{1} << 25;
  /// Bytes that the process holds of the file at most, of all memories together: where
  /// one more would be too many, the half goes that was asked for longest ago.
  static constexpr std::size_t kMostHeld = std::size_t{24} << 20;

  /// What the bytes are before they are written.
  enum class AtFirst { kZero, kAnything };

  ScratchMemory();
  /// `block` [bytes] must be a multiple of 4096. Throws std::bad_alloc.
  ScratchMemory(std::size_t bytes, std::size_t block,
                AtFirst at_first = AtFirst::kZero);
  ScratchMemory(ScratchMemory&& other) noexcept;
  ScratchMemory& operator=(ScratchMemory&& other) noexcept {
    ScratchMemory(std::move(other)).swap(*this);
    return *this;
  }
  ~ScratchMemory();
  void swap(ScratchMemory& other) noexcept;

  std::byte* data() const { return data_; }
  /// Whether a file is behind it.
  bool is_file() const { return mapping_ != nullptr; }

  /// To be called before bytes of a block are read, by any thread, or written, by one
  /// thread while no other touches the memory. The first call makes a block zero
  /// where that was asked for; later ones only keep the memory small.
  void BeforeReading(std::size_t block) const {
    if (held_[block].load(std::memory_order_relaxed) < kRead) {
      Hold(block, kRead);
    }
  }
  void BeforeWriting(std::size_t block) {
    if (held_[block].load(std::memory_order_relaxed) != kWritten) {
      Hold(block, kWritten);
    }
  }
  /// Puts the blocks that are plain memory still into the file, as when no others
  /// will follow soon.
  void EndFilling();
  /// Bytes that the process holds of files, of all memories together.
  static std::size_t held();

 private:
  static constexpr char kUntouched = 0;
  static constexpr char kLetGo = 1;
  static constexpr char kRead = 2;
  static constexpr char kWritten = 3;

  struct Mapping;
  class HeldBlocks;

  void Hold(std::size_t block, char how) const;
  void Fill(std::size_t block) const;

  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t block_ = 1;
  std::unique_ptr<std::atomic<char>[]> held_;  ///< one a block
  std::unique_ptr<Mapping> mapping_;           ///< null: plain memory
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_SCRATCH_MEMORY_H_
