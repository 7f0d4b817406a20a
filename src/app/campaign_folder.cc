#include "app/campaign_folder.h"

#include <algorithm>
#include <system_error>

#include "app/campaign_record.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/read/text_file.h"
#include "io/write/atomic_file.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr char kListName[] = "items.csv";

/// Whether it holds no more than a call leaves that was killed before there was
/// a list.
bool IsBegun(const fs::path& folder) {
  if (!IsFolder(folder)) return false;
  const std::vector<fs::path> entries = FolderEntries(folder);
  return std::all_of(
      entries.begin(), entries.end(), [&](const fs::path& entry) {
        return entry.filename() == "items" ||
               IsUnpublishedName(entry.filename().string(), folder / kListName);
      });
}

/// Makes the folder, or throws InputError where it holds something else.
void PrepareFolder(const fs::path& folder) {
  if (PathExists(folder) && !IsFile(folder / kListName) && !IsBegun(folder)) {
    throw InputError(folder.string() +
                     " is there and no campaign: it holds no " + kListName);
  }
  std::error_code refused;
  fs::create_directories(folder / "items", refused);
  if (refused) {
    throw InputError("output folder " + folder.string() +
                     " cannot be made: " + refused.message());
  }
}

/// What a campaign writes must not become part of what it reads.
void RequireOutside(const fs::path& folder,
                    const std::vector<CampaignItem>& items) {
  for (const CampaignItem& item : items) {
    if (!IsFolder(item.config)) continue;
    const fs::path from = fs::weakly_canonical(folder).lexically_relative(
        fs::weakly_canonical(item.config));
    if (from.empty() || *from.begin() == "..") continue;
    throw InputError("--out=" + folder.string() + " lies in the recording " +
                     item.config.string() + "; expected another folder");
  }
}

}  // namespace

std::vector<CampaignItem> ItemsOf(
    const std::vector<std::string>& list,
    const std::map<std::string, std::string>& given, const fs::path& folder) {
  const std::string known = (folder / kListName).string();
  if (!list.empty()) {
    const auto items = ReadCampaignList(list, given);
    RequireOutside(folder, items);
    PrepareFolder(folder);
    WriteIfOther(known, CampaignListText(items));
    return items;
  }
  if (!IsFile(known)) {
    throw UsageError("'campaign' needs a LIST of recordings: " +
                     folder.string() + " is no campaign yet");
  }
  if (!given.empty()) {
    throw UsageError("--" + given.begin()->first +
                     " goes with a LIST: the items of " + known +
                     " have flags of their own");
  }
  return ReadCampaignList({known}, {});
}

void ForgetFailures(const std::vector<CampaignItem>& items,
                    const fs::path& folder) {
  for (const CampaignItem& item : items) {
    const ItemPlace place(folder, item);
    const auto record = ReadItemRecord(place);
    std::error_code gone;
    if (record && !record->done) fs::remove(place.record, gone);
  }
}

void WriteIfOther(const fs::path& path, const std::string& text) {
  if (IsFile(path) && ReadTextFile(path.string()) == text) return;
  WriteFileAtomically(path.string(), text);
}

}  // namespace hindsight
