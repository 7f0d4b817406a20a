#ifndef HINDSIGHT_BASE_FILE_PIECE_H_
#define HINDSIGHT_BASE_FILE_PIECE_H_

#include <cstddef>

namespace hindsight {

/// Bytes that are written into a file by one call at most. The system's cache of
/// files takes memory in pieces as large as what is written, and large ones are
/// those that nobody has used lately: a virtual machine's host must give them
/// first, which takes ten times as long as writing.
constexpr std::size_t kFilePiece = std::size_t{1} << 16;

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_FILE_PIECE_H_
