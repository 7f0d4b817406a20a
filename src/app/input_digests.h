#ifndef HINDSIGHT_APP_INPUT_DIGESTS_H_
#define HINDSIGHT_APP_INPUT_DIGESTS_H_

#include <filesystem>
#include <future>
#include <vector>

#include "io/read/file_digest.h"

namespace hindsight {

/// Sizes and checksums of a run's inputs. Those of text are made of what its reader
/// reads; the others in a thread of their own while the same files are read: what one of
/// both has read the system still holds.
class InputDigests {
 public:
  explicit InputDigests(std::vector<std::filesystem::path> inputs);

  /// Where the readers' go.
  ReadDigests* read() { return &read_; }
  /// Waits for them, once; each input once, in their order, and here that of text
  /// which nobody has read to its end. Throws InputError if one cannot be read.
  std::vector<FileDigest> Take();

 private:
  std::vector<std::filesystem::path> inputs_;
  ReadDigests read_;
  std::future<void> digesting_;  ///< the last member: it waits
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_INPUT_DIGESTS_H_
