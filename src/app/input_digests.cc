#include "app/input_digests.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace hindsight {
namespace {

std::vector<FileDigest> DigestsOf(
    const std::vector<std::filesystem::path>& inputs) {
  std::vector<FileDigest> digests;
  for (const std::filesystem::path& input : inputs) {
    const bool known = std::any_of(
        digests.begin(), digests.end(),
        [&](const FileDigest& one) { return one.path == input.string(); });
    if (!known) digests.push_back(DigestOf(input));
  }
  return digests;
}

}  // namespace

InputDigests::InputDigests(std::vector<std::filesystem::path> inputs)
    : digests_(InBackground(
          [inputs = std::move(inputs)] { return DigestsOf(inputs); })) {}

}  // namespace hindsight
