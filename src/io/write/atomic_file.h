#ifndef HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_
#define HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_

#include <cstddef>
#include <functional>
#include <future>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/write/unpublished.h"

namespace hindsight {

/// A file that appears complete or not at all: it is written under a temporary
/// name in the same folder (io/write/unpublished.h) and gets its own by
/// Commit(). Every member throws OutputError naming the path if that fails, of what
/// is written beside a later one.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  /// Removes what was written unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered.
  void Write(std::string_view text);
  /// Another file that gets lines as well.
  struct Copy {
    AtomicFile* file;
    std::function<bool(std::size_t i)> has;  ///< whether it gets line i
  };
  /// The lines that `append` makes of 0 to count, in that order. Several threads make
  /// them, and another writes them while the next are made.
  void WriteLines(
      std::size_t count,
      const std::function<void(std::size_t i, std::string* out)>& append,
      const Copy* copy = nullptr);

  /// Returns when the medium has the content and the file has its name. That a
  /// crash of the system leaves the name takes SyncFolder besides. A file of
  /// that name is replaced, or an error without `replace`.
  void Commit(bool replace = true);

 private:
  [[noreturn]] void Fail(const std::error_code& cause) const;
  void Flush();
  /// Into the file, after all that was before.
  void Put(std::string_view text) const;
  void WaitForOthers();
  void WritePieces(std::size_t count);

  std::string path_;
  Unpublished file_;
  std::string buffer_;
  std::vector<std::string> pieces_;   ///< of lines that are made
  std::vector<std::string> written_;  ///< of such that are written
  bool committed_ = false;
  std::future<void> writing_;  ///< the last member: it waits
};

/// Writes `text` as the whole of the file.
void WriteFileAtomically(const std::string& path, std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_ATOMIC_FILE_H_
