#include "io/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr std::size_t kFileBuffer = 1 << 18;

std::string TemporaryName(const std::string& path) {
  static std::atomic<unsigned> counter = 0;
  const std::filesystem::path target(path);
  const std::string name = "." + target.filename().string() + ".partial-" +
                           std::to_string(getpid()) + "-" +
                           std::to_string(counter++);
  return (target.parent_path() / name).string();
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), temporary_(TemporaryName(path)) {
  file_ = std::fopen(temporary_.c_str(), "wbx");
  if (file_ == nullptr) Fail();
  buffer_.reserve(kFileBuffer);
}

AtomicFile::~AtomicFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void AtomicFile::Fail() const {
  throw InputError("output file " + path_ +
                   " cannot be written: " + std::strerror(errno));
}

void AtomicFile::Flush() {
  if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size()) {
    Fail();
  }
  buffer_.clear();
}

void AtomicFile::Write(std::string_view text) {
  if (buffer_.size() + text.size() > kFileBuffer) Flush();
  buffer_.append(text);
}

void AtomicFile::Commit() {
  Flush();
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0 ||
      std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int cause = errno;
    std::remove(temporary_.c_str());
    errno = cause;
    Fail();
  }
}

void WriteFileAtomically(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.Write(text);
  file.Commit();
}

}  // namespace hindsight
