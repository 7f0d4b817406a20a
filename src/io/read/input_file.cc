#include "io/read/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace hindsight {
namespace {

[[noreturn]] void FailWithErrno(const std::string& path) {
  throw InputError(path, 0,
                   std::string("cannot be read: ") + std::strerror(errno));
}

void RequireRegular(const std::string& path, const struct stat& status) {
  if (S_ISREG(status.st_mode)) return;
  const char* kind = S_ISDIR(status.st_mode)    ? "a folder"
                     : S_ISFIFO(status.st_mode) ? "a pipe"
                     : S_ISSOCK(status.st_mode) ? "a socket"
                                                : "a device";
  throw InputError(path, 0,
                   std::string("is ") + kind + "; expected a regular file");
}

}  // namespace

InputFile::InputFile(const std::string& path) : path_(path) {
  struct stat status = {};
  // Opening alone can wind a tape or wait for a writer.
  if (stat(path.c_str(), &status) != 0) FailWithErrno(path);
  RequireRegular(path, status);
  file_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file_ < 0) FailWithErrno(path);
  try {
    if (fstat(file_, &status) != 0) FailWithErrno(path);
    RequireRegular(path, status);
  } catch (...) {
    close(file_);
    throw;
  }
  size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() { close(file_); }

std::size_t InputFile::ReadAt(std::size_t offset, char* data,
                              std::size_t count) const {
  count = std::min(count, size_ - std::min(offset, size_));
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = pread(file_, data + done, count - done,
                              static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) FailWithErrno(path_);
    if (got == 0) {
      throw InputError(path_, 0,
                       "has become shorter while it was read; expected a file "
                       "that nobody writes to");
    }
    done += static_cast<std::size_t>(got);
  }
  return count;
}

}  // namespace hindsight
