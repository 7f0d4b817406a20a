#include "app/input_digests.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/parallel.h"
#include "io/read/gzip_reader.h"
#include "io/read/input_file.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

/// Whether a file begins as text does, which a reader reads as it is.
bool BeginsAsText(const std::filesystem::path& path) {
  if (IsFolder(path)) return false;
  const InputFile file(path.string());
  std::array<char, 4096> begin = {};
  const std::size_t count = file.ReadAt(0, begin.data(), begin.size());
  return !GzipReader::IsGzip(file) &&
         std::string_view(begin.data(), count).find('\0') ==
             std::string_view::npos;
}

}  // namespace

InputDigests::InputDigests(std::vector<std::filesystem::path> inputs)
    : inputs_(std::move(inputs)), digesting_(InBackground([this] {
        for (const std::filesystem::path& input : inputs_) {
          if (!BeginsAsText(input) && read_.Claim(input.string())) {
            read_.Add(DigestOf(input));
          }
        }
      })) {}

std::vector<FileDigest> InputDigests::Take() {
  digesting_.get();
  std::vector<FileDigest> digests;
  for (const std::filesystem::path& input : inputs_) {
    const bool known = std::any_of(
        digests.begin(), digests.end(),
        [&](const FileDigest& one) { return one.path == input.string(); });
    if (known) continue;
    const auto read = read_.Of(input.string());
    digests.push_back(read ? *read : DigestOf(input));
  }
  return digests;
}

}  // namespace hindsight
