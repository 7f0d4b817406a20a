#ifndef HINDSIGHT_IO_READ_FILE_DIGEST_H_
#define HINDSIGHT_IO_READ_FILE_DIGEST_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace hindsight {

/// What tells one input from another.
struct FileDigest {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;  ///< hexadecimal, as sha256sum writes it
  long files = 1;      ///< of a folder: how many are in it
};

/// Of a file, its bytes as they are, packed or not. Of a folder, the sum of its
/// files' sizes and the SHA-256 of the lines "SHA256  NAME" of all regular
/// files below it, NAME relative to the folder, in the order of the names' bytes. Throws
/// InputError if something cannot be read.
FileDigest DigestOf(const std::filesystem::path& path);

/// SHA-256 of a text, hexadecimal.
std::string Sha256Of(std::string_view text);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FILE_DIGEST_H_
