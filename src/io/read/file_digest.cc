#include "io/read/file_digest.h"

#include <openssl/evp.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/read/input_file.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

void Require(bool done) {
  if (!done) throw InputError("libcrypto has no SHA-256");
}

FileDigest DigestOfFile(const fs::path& path) {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  const InputFile file(path.string());
  Sha256 sum;
  std::vector<char> piece(kPiece);
  for (std::size_t offset = 0; offset < file.size(); offset += kPiece) {
    sum.Add({piece.data(), file.ReadAt(offset, piece.data(), kPiece)});
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

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  Require(context_ != nullptr &&
          EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256::Add(std::string_view piece) {
  Require(EVP_DigestUpdate(context_.get(), piece.data(), piece.size()) == 1);
}

std::string Sha256::Hexadecimal() {
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

bool ReadDigests::Claim(const std::string& path) {
  const std::lock_guard<std::mutex> guard(mutex_);
  return claimed_.insert(path).second;
}

void ReadDigests::Add(FileDigest digest) {
  const std::lock_guard<std::mutex> guard(mutex_);
  digests_.push_back(std::move(digest));
}

std::optional<FileDigest> ReadDigests::Of(const std::string& path) const {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found =
      std::find_if(digests_.begin(), digests_.end(),
                   [&](const FileDigest& one) { return one.path == path; });
  if (found == digests_.end()) return std::nullopt;
  return *found;
}

std::string Sha256Of(std::string_view text) {
  Sha256 sum;
  sum.Add(text);
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
    sum.Add(one.sha256 + "  " + name + "\n");
    all.bytes += one.bytes;
    ++all.files;
  }
  all.sha256 = sum.Hexadecimal();
  return all;
}

}  // namespace hindsight
