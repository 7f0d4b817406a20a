#ifndef HINDSIGHT_IO_READ_UNPACK_H_
#define HINDSIGHT_IO_READ_UNPACK_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hindsight {

/// What bz2 or lz4 (frames) made smaller, `size` bytes of it; nothing if the
/// data are damaged, cut off or hold another number of bytes. Memory follows
/// what is unpacked, not `size`.
std::optional<std::string> UnpackBz2(std::string_view packed, std::size_t size);
std::optional<std::string> UnpackLz4(std::string_view packed, std::size_t size);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_UNPACK_H_
