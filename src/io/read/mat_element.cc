#include "io/read/mat_element.h"

#include <algorithm>
#include <array>
#include <new>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr std::size_t kPackedPiece = std::size_t{1} << 16;
/// Deflated data are never longer than this times their size.
constexpr std::size_t kDeflateLimit = 1032;

}  // namespace

MatElement::MatElement(const InputFile& file, std::size_t offset,
                       std::size_t size, bool compressed)
    : file_(file), offset_(offset), end_(offset + size) {
  if (!compressed) return;
  stream_ = std::make_unique<z_stream>();
  packed_.resize(kPackedPiece);
  if (inflateInit(stream_.get()) != Z_OK) throw std::bad_alloc();
}

MatElement::~MatElement() {
  if (stream_) inflateEnd(stream_.get());
}

void MatElement::Fail(const std::string& what) const {
  throw InputError(
      file_.path(), 0,
      (name_.empty() ? "a variable" : "the variable '" + name_ + "'") +
          " is damaged: " + what + "; expected a whole MATLAB file");
}

void MatElement::Read(char* data, std::size_t count) {
  left_ -= std::min(left_, count);
  if (stream_) {
    if (Inflate(data, count) != count) Fail("its data end too early");
    return;
  }
  if (count > end_ - offset_ || file_.ReadAt(offset_, data, count) < count) {
    Fail("its parts are longer than it");
  }
  offset_ += count;
}

void MatElement::Skip(std::size_t count) {
  std::array<char, 4096> ignored;
  while (count > 0) {
    const std::size_t piece = std::min(count, ignored.size());
    Read(ignored.data(), piece);
    count -= piece;
  }
}

std::size_t MatElement::Most() const {
  const std::size_t left = end_ - offset_;
  return stream_ ? (left + stream_->avail_in) * kDeflateLimit : left;
}

void MatElement::Finish() {
  if (!stream_) return;
  char beyond = 0;
  if (Inflate(&beyond, 1) != 0) Fail("it holds more than it says");
}

std::size_t MatElement::Inflate(char* data, std::size_t count) {
  stream_->next_out = reinterpret_cast<unsigned char*>(data);
  stream_->avail_out = static_cast<unsigned>(count);
  while (!finished_ && stream_->avail_out > 0) {
    if (stream_->avail_in == 0) {
      const std::size_t got = file_.ReadAt(
          offset_, packed_.data(), std::min(packed_.size(), end_ - offset_));
      offset_ += got;
      stream_->next_in = reinterpret_cast<unsigned char*>(packed_.data());
      stream_->avail_in = static_cast<unsigned>(got);
    }
    const int code = inflate(stream_.get(), Z_NO_FLUSH);
    finished_ = code == Z_STREAM_END;
    if (code != Z_OK && code != Z_STREAM_END) {
      Fail("its compressed data are not whole");
    }
  }
  return count - stream_->avail_out;
}

}  // namespace hindsight
