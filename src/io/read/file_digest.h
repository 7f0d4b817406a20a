#ifndef HINDSIGHT_IO_READ_FILE_DIGEST_H_
#define HINDSIGHT_IO_READ_FILE_DIGEST_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

struct evp_md_ctx_st;

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

/// SHA-256 of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  void Add(std::string_view piece);
  /// Of all pieces, once.
  std::string Hexadecimal();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// Digests of files that others read to their ends, made of what they read: the system
/// need not copy it twice. Any thread may use it.
class ReadDigests {
 public:
  /// Whether nobody else makes the digest of a file, which the caller does now.
  bool Claim(const std::string& path);
  void Add(FileDigest digest);
  /// None of a file that nobody has read to its end.
  std::optional<FileDigest> Of(const std::string& path) const;

 private:
  mutable std::mutex mutex_;
  std::set<std::string> claimed_;
  std::vector<FileDigest> digests_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FILE_DIGEST_H_
