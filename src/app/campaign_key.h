#ifndef HINDSIGHT_APP_CAMPAIGN_KEY_H_
#define HINDSIGHT_APP_CAMPAIGN_KEY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "app/campaign_list.h"

namespace hindsight {

/// An input, a file or a folder, as it was when it was hashed. The hash of a
/// folder is that of the names in it, which are inputs themselves.
struct HashedInput {
  std::string path;
  std::uint64_t bytes = 0;
  std::int64_t changed = 0;  ///< time of last change [ns since 1970]
  std::string sha256;        ///< "" of what could not be read
  /// Size and time speak for the content: it had not changed within the two
  /// seconds before it was hashed, in which a further change might have left
  /// the same time.
  bool settled = false;
};

/// What decides an item's results: the hash of the configuration, of all that
/// it reads, of the flags and of the program's build.
struct ItemKey {
  std::string sha256;
  std::vector<HashedInput> inputs;
};

/// `known` spares hashing those of its inputs whose size and time of change are
/// what they were. What cannot be read is part of the key as such.
ItemKey KeyOf(const CampaignItem& item, const ItemKey& known);

/// Whether an input is certainly what it was, by size and time.
bool IsUnchanged(const HashedInput& known);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_KEY_H_
