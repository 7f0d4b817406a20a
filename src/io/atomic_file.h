#ifndef HINDSIGHT_IO_ATOMIC_FILE_H_
#define HINDSIGHT_IO_ATOMIC_FILE_H_

#include <cstdio>
#include <string>
#include <string_view>

namespace hindsight {

/// A file that appears complete or not at all: it is written under a temporary
/// name in the same folder and gets its own name by Commit(), which replaces a
/// file of that name.
class AtomicFile {
 public:
  /// Throws InputError naming `path` if its folder cannot be written.
  explicit AtomicFile(const std::string& path);
  /// Removes what was written unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Buffered. Throws InputError naming the path if the medium fails.
  void Write(std::string_view text);

  /// Throws InputError naming the path if the file cannot be completed.
  void Commit();

 private:
  [[noreturn]] void Fail() const;
  void Flush();

  std::string path_;
  std::string temporary_;
  std::FILE* file_ = nullptr;
  std::string buffer_;
};

/// Writes `text` as the whole of the file.
void WriteFileAtomically(const std::string& path, std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_ATOMIC_FILE_H_
