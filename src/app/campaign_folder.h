#ifndef HINDSIGHT_APP_CAMPAIGN_FOLDER_H_
#define HINDSIGHT_APP_CAMPAIGN_FOLDER_H_

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/campaign_list.h"

namespace hindsight {

/// \file
/// The folder of a campaign, which holds its list and a folder each item.

/// The items of a list (ReadCampaignList), which becomes that of the folder;
/// without one, of the folder's. `given` are the flags of `run` for all items of a
/// list. Makes the folder. Throws UsageError, and InputError where it holds
/// something else, cannot be made or lies in one of the recordings.
std::vector<CampaignItem> ItemsOf(
    const std::vector<std::string>& list,
    const std::map<std::string, std::string>& given,
    const std::filesystem::path& folder);

/// What failed becomes open again.
void ForgetFailures(const std::vector<CampaignItem>& items,
                    const std::filesystem::path& folder);

/// Leaves a file of that text as it is. Throws OutputError.
void WriteIfOther(const std::filesystem::path& path, const std::string& text);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CAMPAIGN_FOLDER_H_
