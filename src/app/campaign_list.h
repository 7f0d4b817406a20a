#ifndef HINDSIGHT_APP_CAMPAIGN_LIST_H_
#define HINDSIGHT_APP_CAMPAIGN_LIST_H_

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/command.h"

namespace hindsight {

/// One recording of a campaign and how it is run.
struct CampaignItem {
  std::string name;  ///< of its folder of results; unique
  /// Absolute; or the folder of a recording without one.
  std::filesystem::path config;
  /// Flags of `run` by name with dashes, and their values.
  std::map<std::string, std::string> flags;

  /// Of a flag, "" if it is not there.
  std::string Flag(const std::string& name) const;
};

/// The flags of `run` that a campaign passes on: all but those that say where
/// results go and what is printed.
std::vector<FlagUse> PassedFlags();

/// The items that words name: a configuration, a folder (that of a recording, if
/// it holds no config.yaml), a pattern of either with *, ? or [...], or a CSV
/// (FILE.csv) with a line an
/// item: column `config`, relative to the CSV, `name` where the folder's or the
/// configuration's does not do, and columns of flags of `run`, of which an
/// empty cell is one not given. `common` are flags of every item that has no
/// value of its own. Items of one name get those of the folders above before
/// it. Throws UsageError and InputError.
std::vector<CampaignItem> ReadCampaignList(
    const std::vector<std::string>& words,
    const std::map<std::string, std::string>& common);

/// Such a CSV of the items, with absolute paths.
std::string CampaignListText(const std::vector<CampaignItem>& items);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_LIST_H_
