#ifndef HINDSIGHT_APP_CAMPAIGN_RECORD_H_
#define HINDSIGHT_APP_CAMPAIGN_RECORD_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/campaign_key.h"
#include "app/child_process.h"

namespace hindsight {

/// Where an item's files lie, below the campaign's folder.
struct ItemPlace {
  explicit ItemPlace(const std::filesystem::path& campaign,
                     const CampaignItem& item);
  std::filesystem::path folder;   ///< items/NAME
  std::filesystem::path results;  ///< items/NAME/results, of `run`
  std::filesystem::path log;      ///< items/NAME/log.txt
  std::filesystem::path record;   ///< items/NAME/item.json
};

/// How an item ended; the text of its item.json.
struct ItemRecord {
  ItemKey key;
  std::string build;                         ///< of the program
  std::map<std::string, std::string> flags;  ///< of the item
  bool done = false;   ///< there are complete results, of whatever grade
  std::string reason;  ///< why it failed, or the verdict of the best method
  std::string grade;   ///< of `run`; "" if it failed
  std::string best;    ///< method
  /// Of the best method: horizontal RMS against withheld positions [m], mean
  /// normalised squared residual a row over the measurements used, rests and
  /// other constraints apart (1 is right), names of what is not observed.
  std::optional<double> withheld_rms;
  std::optional<double> nis;
  std::string unobserved;
  /// By the clock, and largest memory [MB]; absent where the worker that knew
  /// them is gone.
  std::optional<double> seconds;
  std::optional<double> megabytes;
};

/// Nothing if there is none or it is damaged.
std::optional<ItemRecord> ReadItemRecord(const ItemPlace& place);
/// Throws OutputError.
void WriteItemRecord(const ItemRecord& record, const ItemPlace& place);

/// Whether the record is of this item, build, flags and inputs as they are by
/// size and time: true spares KeyOf.
bool IsCertainlyOf(const ItemRecord& record, const CampaignItem& item);

/// Fills in what complete results say; false where there are none.
bool TakeResults(const ItemPlace& place, ItemRecord* record);

/// Why an item has no results, from how its process ended and its log.
std::string FailureOf(const ChildEnd& end, const ChildLimits& limits,
                      const ItemPlace& place);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_RECORD_H_
