#include "io/read/file_digest.h"

#include <openssl/evp.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "io/read/input_file.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    Require(context_ != nullptr &&
            EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void Add(const char* data, std::size_t count) {
    Require(EVP_DigestUpdate(context_.get(), data, count) == 1);
  }

  std::string Hexadecimal() {
    unsigned char bytes[EVP_MAX_MD_SIZE];
    unsigned count = 0;
    Require(EVP_DigestFinal_ex(context_.get(), bytes, &count) == 1);
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (unsigned i = 0; i < count; ++i) {
      text += kDigits[bytes[i] >> 4];
      text += kDigits[bytes[i] & 15];
    }
    return text;
  }

 private:
  static void Require(bool done) {
    if (!done) throw InputError("libcrypto has no SHA-256");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

FileDigest DigestOfFile(const fs::path& path) {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  const InputFile file(path.string());
  Sha256 sum;
  std::vector<char> piece(kPiece);
  for (std::size_t offset = 0; offset < file.size(); offset += kPiece) {
    sum.Add(piece.data(), file.ReadAt(offset, piece.data(), kPiece));
  }
  return {path.string(), file.size(), sum.Hexadecimal()};
}

/// Regular files below a folder, by their names relative to it; folders that
/// are links are not followed.
void ListFiles(const fs::path& folder, const std::string& prefix,
               std::vector<std::string>* names) {
  for (const fs::path& entry : FolderEntries(folder)) {
    const std::string name = prefix + entry.filename().string();
    std::error_code ignored;
    if (IsFile(entry)) {
      names->push_back(name);
    } else if (IsFolder(entry) && !fs::is_symlink(entry, ignored)) {
      ListFiles(entry, name + "/", names);
    }
  }
}

}  // namespace

std::string Sha256Of(std::string_view text) {
  Sha256 sum;
  sum.Add(text.data(), text.size());
  return sum.Hexadecimal();
}

FileDigest DigestOf(const fs::path& path) {
  if (!IsFolder(path)) return DigestOfFile(path);
  std::vector<std::string> names;
  ListFiles(path, "", &names);
  std::sort(names.begin(), names.end());
  FileDigest all = {path.string(), 0, "", 0};
  Sha256 sum;
  for (const std::string& name : names) {
    const FileDigest one = DigestOfFile(path / name);
    const std::string line = one.sha256 + "  " + name + "\n";
    sum.Add(line.data(), line.size());
    all.bytes += one.bytes;
    ++all.files;
  }
  all.sha256 = sum.Hexadecimal();
  return all;
}

}  // namespace hindsight
