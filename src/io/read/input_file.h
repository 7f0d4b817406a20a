#ifndef HINDSIGHT_IO_READ_INPUT_FILE_H_
#define HINDSIGHT_IO_READ_INPUT_FILE_H_

#include <cstddef>
#include <string>

namespace hindsight {

/// A regular file open for reading; what is appended to it meanwhile is not
/// seen. Nothing is mapped into memory, so that a file that shrinks is an error
/// and no crash.
class InputFile {
 public:
  /// Throws InputError if there is no such file, it may not be read, or it is
  /// something else than a regular file: a folder, a pipe, a device. Never
  /// waits for somebody to write.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  /// Bytes when it was opened.
  std::size_t size() const { return size_; }

  /// Copies up to `count` bytes from `offset` on, fewer only at the end of the
  /// file; returns their number. Throws InputError if the file has become
  /// shorter or cannot be read.
  std::size_t ReadAt(std::size_t offset, char* data, std::size_t count) const;

 private:
  std::string path_;
  int file_ = -1;
  std::size_t size_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_INPUT_FILE_H_
