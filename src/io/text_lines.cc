#include "io/text_lines.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace hindsight {

/// Yields a file's text as a window that grows at its end.
class TextLines::Source {
 public:
  virtual ~Source() = default;
  /// Keeps `rest`, the tail of the last window, and puts more text behind it.
  /// The returned window is no longer than `rest` at the end of the file.
  virtual std::string_view Extend(std::string_view rest) = 0;
  std::size_t size_hint = 0;
};

namespace {

constexpr std::size_t kPiece = std::size_t{4} << 20;
/// Deflated text is never longer than this times the file.
constexpr std::size_t kDeflateLimit = 1032;

class MappedSource : public TextLines::Source {
 public:
  MappedSource(const std::string& path, int file, std::size_t size)
      : size_(size) {
    void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (address == MAP_FAILED) {
      throw InputError(path, 0,
                       std::string("cannot be read: ") + std::strerror(errno));
    }
    data_ = static_cast<const char*>(address);
    madvise(address, size, MADV_SEQUENTIAL);
  }
  ~MappedSource() override { munmap(const_cast<char*>(data_), size_); }

  std::string_view Extend(std::string_view rest) override {
    const std::size_t begin = shown_ - rest.size();
    // Pages read already would otherwise count as the program's memory.
    const std::size_t done = begin / kPiece * kPiece;
    if (done > released_) {
      madvise(const_cast<char*>(data_) + released_, done - released_,
              MADV_DONTNEED);
      released_ = done;
    }
    shown_ = std::min(size_, shown_ + kPiece);
    return {data_ + begin, shown_ - begin};
  }

 private:
  const char* data_ = nullptr;
  std::size_t size_;
  std::size_t shown_ = 0;
  std::size_t released_ = 0;
};

class GzipSource : public TextLines::Source {
 public:
  explicit GzipSource(const std::string& path)
      : path_(path), file_(gzopen(path.c_str(), "rb")) {
    if (file_ == nullptr) throw InputError(path, 0, "cannot be read");
    gzbuffer(file_, 1 << 18);
  }
  ~GzipSource() override { gzclose(file_); }

  std::string_view Extend(std::string_view rest) override {
    std::string next;
    next.reserve(rest.size() + kPiece);
    next.assign(rest);
    next.resize(rest.size() + kPiece);
    const int count =
        gzread(file_, next.data() + rest.size(), static_cast<unsigned>(kPiece));
    // A cut-off file reads short without an error until it is asked for one.
    int code = Z_OK;
    gzerror(file_, &code);
    if (count < 0 || (code != Z_OK && code != Z_STREAM_END)) {
      throw InputError(path_, 0,
                       "damaged gzip data; expected a complete .gz file");
    }
    next.resize(rest.size() + static_cast<std::size_t>(count));
    text_.swap(next);
    return text_;
  }

 private:
  std::string path_;
  gzFile file_;
  std::string text_;
};

/// Closes the descriptor when the file is mapped or refused.
struct Descriptor {
  int file = -1;
  ~Descriptor() {
    if (file >= 0) close(file);
  }
};

std::unique_ptr<TextLines::Source> OpenSource(const std::string& path) {
  const Descriptor descriptor{open(path.c_str(), O_RDONLY)};
  struct stat status = {};
  if (descriptor.file < 0 || fstat(descriptor.file, &status) != 0) {
    throw InputError(path, 0,
                     std::string("cannot be read: ") + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    throw InputError(path, 0, "is not a file");
  }
  std::array<unsigned char, 2> magic = {};
  const ssize_t count = pread(descriptor.file, magic.data(), magic.size(), 0);
  if (status.st_size == 0) throw InputError(path, 0, "the file is empty");
  const auto size = static_cast<std::size_t>(status.st_size);
  std::unique_ptr<TextLines::Source> source;
  if (count == 2 && magic[0] == 0x1f && magic[1] == 0x8b) {
    source = std::make_unique<GzipSource>(path);
    std::array<unsigned char, 4> tail = {};
    if (pread(descriptor.file, tail.data(), 4, status.st_size - 4) == 4) {
      source->size_hint = tail[0] | std::size_t{tail[1]} << 8 |
                          std::size_t{tail[2]} << 16 |
                          std::size_t{tail[3]} << 24;
      // A damaged tail must not make readers reserve more than there can be.
      source->size_hint = std::min(source->size_hint, kDeflateLimit * size);
    }
  } else {
    source = std::make_unique<MappedSource>(path, descriptor.file, size);
    source->size_hint = size;
  }
  return source;
}

}  // namespace

TextLines::TextLines(const std::string& path)
    : path_(path), source_(OpenSource(path)) {
  size_hint_ = source_->size_hint;
  window_ = source_->Extend({});
  if (window_.empty()) throw InputError(path, 0, "the file is empty");
  if (window_.starts_with("\xEF\xBB\xBF")) window_.remove_prefix(3);
}

TextLines::~TextLines() = default;

bool TextLines::Next(std::string_view* line) {
  std::size_t searched = 0;
  while (true) {
    const void* found = searched == window_.size()
                            ? nullptr
                            : std::memchr(window_.data() + searched, '\n',
                                          window_.size() - searched);
    if (found != nullptr) {
      const auto length = static_cast<std::size_t>(
          static_cast<const char*>(found) - window_.data());
      *line = window_.substr(0, length);
      window_.remove_prefix(length + 1);
      terminated_ = true;
      break;
    }
    searched = window_.size();
    window_ = source_->Extend(window_);
    if (window_.size() > searched) continue;
    if (window_.empty()) return false;
    *line = window_;
    window_ = {};
    terminated_ = false;
    break;
  }
  if (line->ends_with('\r')) line->remove_suffix(1);
  ++number_;
  return true;
}

}  // namespace hindsight
