#include "io/read/gzip_reader.h"

#include <algorithm>
#include <array>
#include <new>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr std::size_t kPacked = std::size_t{1} << 18;
/// Tables of numbers deflate to a half or a fifth.
constexpr std::size_t kUsualLimit = 64;
/// zlib's windowBits: the largest window, a gzip header.
constexpr int kGzipWindow = 15 + 16;

bool IsMagic(const unsigned char* bytes) {
  return bytes[0] == 0x1f && bytes[1] == 0x8b;
}

}  // namespace

bool GzipReader::IsGzip(const InputFile& file) {
  std::array<char, 2> magic = {};
  return file.ReadAt(0, magic.data(), magic.size()) == magic.size() &&
         IsMagic(reinterpret_cast<const unsigned char*>(magic.data()));
}

GzipReader::GzipReader(const InputFile& file) : file_(file), packed_(kPacked) {
  if (inflateInit2(&stream_, kGzipWindow) != Z_OK) throw std::bad_alloc();
}

GzipReader::~GzipReader() { inflateEnd(&stream_); }

bool GzipReader::Refill() {
  const std::size_t count =
      file_.ReadAt(offset_, packed_.data(), packed_.size());
  offset_ += count;
  stream_.next_in = reinterpret_cast<unsigned char*>(packed_.data());
  stream_.avail_in = static_cast<unsigned>(count);
  return count > 0;
}

bool GzipReader::NextStream() {
  const std::size_t rest = stream_.avail_in + (file_.size() - offset_);
  if (rest == 0) return false;
  std::array<char, 2> next = {};
  file_.ReadAt(file_.size() - rest, next.data(), next.size());
  if (rest < next.size() ||
      !IsMagic(reinterpret_cast<const unsigned char*>(next.data()))) {
    throw InputError(file_.path(), 0,
                     "holds " + std::to_string(rest) +
                         " bytes behind the end of its gzip data; expected a "
                         ".gz file and nothing else");
  }
  inflateReset(&stream_);
  return true;
}

std::size_t GzipReader::Read(char* data, std::size_t count) {
  stream_.next_out = reinterpret_cast<unsigned char*>(data);
  stream_.avail_out = static_cast<unsigned>(count);
  while (!finished_ && stream_.avail_out == count) {
    const bool more = stream_.avail_in > 0 || Refill();
    const int code = inflate(&stream_, Z_NO_FLUSH);
    if (code == Z_STREAM_END) {
      finished_ = !NextStream();
    } else if (!more) {
      throw InputError(file_.path(), 0,
                       "is cut off: it ends within its gzip data; expected a "
                       "complete .gz file (`gzip -dc` saves the rows before)");
    } else if (code != Z_OK) {
      throw InputError(file_.path(), 0,
                       "damaged gzip data; expected a complete .gz file");
    }
  }
  return count - stream_.avail_out;
}

std::size_t GzipReader::size_hint() const {
  constexpr std::size_t kSize = 4;
  std::array<char, kSize> tail = {};
  if (file_.size() < kSize) return 0;
  file_.ReadAt(file_.size() - kSize, tail.data(), kSize);
  std::size_t size = 0;
  for (std::size_t i = kSize; i-- > 0;) {
    size = size << 8 | static_cast<unsigned char>(tail[i]);
  }
  return std::min(size, kUsualLimit * file_.size());
}

}  // namespace hindsight
