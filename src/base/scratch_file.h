#ifndef HINDSIGHT_BASE_SCRATCH_FILE_H_
#define HINDSIGHT_BASE_SCRATCH_FILE_H_

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace hindsight {

/// A file without a name in $TMPDIR, or in /var/tmp, that grows by extents, of which
/// those that are given back are handed out again: their pages are there already,
/// where the system clears each new one. Any thread may use it.
class ScratchFile {
 public:
  static constexpr std::size_t kExtent = std::size_t{1} << 23;  // [bytes]

  /// The one that memories of this process share, nullptr if there can be none.
  static std::shared_ptr<ScratchFile> Shared();

  explicit ScratchFile(std::string folder);
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  int descriptor() const { return file_; }

  /// Numbers of extents in ascending order, none if the disk has no room for them.
  /// Their place on the disk is taken at once: a disk that is full later would end
  /// the process. `all_zero` says that nothing was written to any of them.
  std::vector<std::size_t> Take(std::size_t count, bool* all_zero);
  void GiveBack(const std::vector<std::size_t>& extents);

 private:
  bool Grow(std::size_t count);

  std::string folder_;
  int file_;
  std::mutex mutex_;
  std::size_t size_ = 0;           ///< [extents]
  std::vector<std::size_t> free_;  ///< the last ones go first
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_SCRATCH_FILE_H_
