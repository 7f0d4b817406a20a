#ifndef HINDSIGHT_APP_INPUT_DIGESTS_H_
#define HINDSIGHT_APP_INPUT_DIGESTS_H_

#include <filesystem>
#include <future>
#include <vector>

#include "io/read/file_digest.h"

namespace hindsight {

/// Sizes and checksums of a run's inputs, found in a thread of their own while
/// the same files are read: what one of both has read the system still holds.
class InputDigests {
 public:
  explicit InputDigests(std::vector<std::filesystem::path> inputs);

  /// Waits for them, once; each input once, in their order. Throws InputError
  /// if one cannot be read.
  std::vector<FileDigest> Take() { return digests_.get(); }

 private:
  std::future<std::vector<FileDigest>> digests_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_INPUT_DIGESTS_H_
