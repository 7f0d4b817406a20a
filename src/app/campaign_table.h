#ifndef HINDSIGHT_APP_CAMPAIGN_TABLE_H_
#define HINDSIGHT_APP_CAMPAIGN_TABLE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign.h"

namespace hindsight {

/// What is known of an item.
struct CampaignRow {
  CampaignItem item;
  std::optional<ItemRecord> record;  ///< absent: it has not ended
  std::string report;  ///< its page, from the campaign's folder; "": none
};

/// By what is in the folder, worst first: failed, open, not usable, doubtful,
/// usable; of equal ones the largest error against withheld positions, then the
/// NIS farthest from 1, then by name.
std::vector<CampaignRow> ReadCampaign(const std::vector<CampaignItem>& items,
                                      const std::filesystem::path& folder);

/// A line an item: name, state (done, failed, open), grade, best method,
/// withheld_rms[m], nis, unobserved, reason, config, report (from the
/// campaign's folder), seconds, mb. Two campaigns over the same items have the
/// same bytes but for the last two columns.
std::string CampaignCsv(const std::vector<CampaignRow>& rows);

/// The same as a page that opens without a network, with links.
std::string CampaignPage(const std::vector<CampaignRow>& rows,
                         const std::filesystem::path& folder);

/// "9 items: 7 usable, 1 doubtful, 1 failed.".
std::string CampaignCounts(const std::vector<CampaignRow>& rows);

/// What failed and why, and the counts, for a terminal.
std::string CampaignText(const std::vector<CampaignRow>& rows);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_TABLE_H_
