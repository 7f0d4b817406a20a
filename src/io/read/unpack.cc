#include "io/read/unpack.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>
#include <new>

namespace hindsight {
namespace {

constexpr std::size_t kUnpackPiece = std::size_t{1} << 20;

/// Makes room for the next piece of at most `size` bytes in all, and one more,
/// so that too many are noticed.
std::size_t Grow(std::size_t done, std::size_t size, std::string* bytes) {
  const std::size_t room = std::min(kUnpackPiece, size + 1 - done);
  bytes->resize(done + room);
  return room;
}

}  // namespace

std::optional<std::string> UnpackBz2(std::string_view packed,
                                     std::size_t size) {
  bz_stream stream = {};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> guard(
      &stream, BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(packed.data());
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::string bytes;
  std::size_t done = 0;
  while (done <= size) {
    const std::size_t room = Grow(done, size, &bytes);
    stream.next_out = bytes.data() + done;
    stream.avail_out = static_cast<unsigned>(room);
    const int code = BZ2_bzDecompress(&stream);
    done += room - stream.avail_out;
    if (code == BZ_STREAM_END) break;
    const bool stuck = stream.avail_in == 0 && stream.avail_out > 0;
    if (code != BZ_OK || stuck) return std::nullopt;
  }
  if (done != size || stream.avail_in != 0) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

std::optional<std::string> UnpackLz4(std::string_view packed,
                                     std::size_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> guard(
      context, LZ4F_freeDecompressionContext);
  std::string bytes;
  std::size_t done = 0;
  std::size_t more = 1;
  while (more != 0 && done <= size) {
    std::size_t room = Grow(done, size, &bytes);
    std::size_t taken = packed.size();
    more = LZ4F_decompress(context, bytes.data() + done, &room, packed.data(),
                           &taken, nullptr);
    if (LZ4F_isError(more) || (room == 0 && taken == 0)) return std::nullopt;
    done += room;
    packed.remove_prefix(taken);
  }
  if (done != size || !packed.empty()) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

}  // namespace hindsight
