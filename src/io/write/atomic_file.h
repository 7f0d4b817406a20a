#ifndef HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_
#define HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

#include "io/write/unpublished.h"

namespace hindsight {

/// A file that appears complete or not at all: it is written under a temporary
/// name in the same folder (io/write/unpublished.h) and gets its own by
/// Commit(). Every member throws OutputError naming the path if that fails.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  /// Removes what was written unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered.
  void Write(std::string_view text);

  /// Returns when the medium has the content and the file has its name. That a
  /// crash of the system leaves the name takes SyncFolder besides. A file of
  /// that name is replaced, or an error without `replace`.
  void Commit(bool replace = true);

 private:
  [[noreturn]] void Fail(const std::error_code& cause) const;
  void Flush();

  std::string path_;
  Unpublished file_;
  std::string buffer_;
  bool committed_ = false;
};

/// Writes the lines that `append` makes of 0 to count, in that order; several threads
/// make them.
void WriteLines(
    std::size_t count,
    const std::function<void(std::size_t i, std::string* out)>& append,
    AtomicFile* file);

/// Writes `text` as the whole of the file.
void WriteFileAtomically(const std::string& path, std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_
