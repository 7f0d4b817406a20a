#ifndef HINDSIGHT_APP_CAMPAIGN_H_
#define HINDSIGHT_APP_CAMPAIGN_H_

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/campaign_list.h"
#include "app/campaign_record.h"
#include "app/child_process.h"
#include "io/write/claim.h"

namespace hindsight {

struct CampaignOptions {
  std::filesystem::path folder;  ///< absolute
  int workers = 1;               ///< items at once
  ChildLimits limits;            ///< of each item
  double stale_after = 60.0;     ///< [s] see Claim
  /// Called with the share of the items that have ended, one call at a time.
  std::function<void(double)> progress = {};
};

/// The record of an item, if it is of its key; nothing: the item is open.
std::optional<ItemRecord> RecordOf(const CampaignItem& item,
                                   const ItemPlace& place);

/// Works through items, each a process `hindsight run` of its own, together
/// with all others, here and on other machines, that do the same in the folder.
/// What is known of an item is in its folder alone:
///   claim.N    while somebody works on it (io/write/claim.h)
///   results/   of `run`
///   log.txt    what it printed
///   item.json  how it ended (ItemRecord), written last
/// Whoever ends in between leaves a claim that dies; the next one takes over
/// results that were complete and starts an item that was not once more.
class Campaign {
 public:
  Campaign(std::vector<CampaignItem> items, CampaignOptions options);

  /// Returns when every item has ended, here or elsewhere, or Stop was called.
  /// An item that cannot be claimed or recorded, as on a full disk, is left
  /// open, with a note on standard error.
  void Work();

  /// Ends the processes and leaves their items open; returns when no work is
  /// under way any more, at most half a minute later.
  void Stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    std::size_t item;
    Clock::time_point not_before;
  };

  void Worker();
  bool Next(Waiting* next);
  bool Try(std::size_t i);
  void Do(std::size_t i, const ItemPlace& place, Claim* claim);
  bool Run(std::size_t i, const ItemPlace& place, const Claim& claim,
           ItemRecord* record);
  void KeepClaimsAlive();

  std::vector<CampaignItem> items_;
  CampaignOptions options_;
  Children children_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::set<const Claim*> claims_;  ///< that are to be kept alive
  std::size_t ended_ = 0;
  int under_way_ = 0;  ///< items that threads work on
  bool is_stopped_ = false;
  bool is_over_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_H_
