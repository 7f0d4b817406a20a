#include "app/campaign_key.h"

#include <sys/stat.h>

#include <chrono>
#include <filesystem>

#include "app/build_id.h"
#include "app/flags.h"
#include "app/run_output.h"
#include "base/error.h"
#include "io/config/config.h"
#include "io/config/constants_reader.h"
#include "io/read/file_digest.h"
#include "io/read/paths.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kSettling = 2'000'000'000;  // [ns]

std::int64_t SystemTime() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Size and time of change as they are; the rest is empty. Those of a folder
/// change with the names in it.
HashedInput FileStatus(const std::string& path) {
  HashedInput input = {.path = path, .sha256 = ""};
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return input;
  constexpr std::int64_t kSecond = 1'000'000'000;
  input.bytes = static_cast<std::uint64_t>(status.st_size);
  input.changed =
      kSecond * status.st_mtim.tv_sec + std::int64_t{status.st_mtim.tv_nsec};
  input.settled = (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) &&
                  SystemTime() - input.changed > kSettling;
  return input;
}

/// A file, or a folder with all that is below it but behind links.
void AddWithContent(const fs::path& path, std::vector<fs::path>* inputs) {
  inputs->push_back(path);
  if (!IsFolder(path)) return;
  try {
    for (const fs::path& entry : FolderEntries(path)) {
      std::error_code ignored;
      if (IsFolder(entry) && fs::is_symlink(entry, ignored)) {
        inputs->push_back(entry);
      } else {
        AddWithContent(entry, inputs);
      }
    }
  } catch (const InputError&) {
    // Its name stands for what cannot be listed.
  }
}

std::vector<fs::path> InputsOfItem(const CampaignItem& item) {
  const std::string constants = item.Flag("constants");
  std::vector<fs::path> named = {item.config};
  if (IsFolder(item.config)) {
    if (!constants.empty()) named.push_back(SummaryOf(constants));
  } else {
    try {
      named = ConfigFilesRead(item.config.string(),
                              {.data_root = item.Flag("data-root"),
                               .without = Split(item.Flag("without"), ','),
                               .constants = constants});
    } catch (const InputError&) {
      // `run` will say what is wrong with it.
    }
  }
  if (!item.Flag("at").empty()) named.emplace_back(item.Flag("at"));
  std::vector<fs::path> inputs;
  for (const fs::path& path : named) AddWithContent(path, &inputs);
  return inputs;
}

std::string ContentDigest(const std::string& path) {
  if (!IsFolder(path)) return DigestOf(path).sha256;
  std::string names;
  for (const fs::path& entry : FolderEntries(path)) {
    names += entry.filename().string() + '\n';
  }
  return Sha256Of(names);
}

HashedInput HashedAs(const std::string& path, const ItemKey& known) {
  for (const HashedInput& one : known.inputs) {
    if (one.path == path && IsUnchanged(one)) return one;
  }
  HashedInput input = FileStatus(path);
  try {
    input.sha256 = ContentDigest(path);
  } catch (const InputError&) {
    input.settled = false;
  }
  return input;
}

}  // namespace

bool IsUnchanged(const HashedInput& known) {
  if (!known.settled) return false;
  const HashedInput now = FileStatus(known.path);
  return now.settled && now.bytes == known.bytes &&
         now.changed == known.changed;
}

ItemKey KeyOf(const CampaignItem& item, const ItemKey& known) {
  ItemKey key;
  std::string text = "build " + BuildId() + "\n";
  for (const auto& [name, value] : item.flags) {
    text += "flag " + std::to_string(value.size()) + " " + name + "=" + value +
            "\n";
  }
  for (const fs::path& path : InputsOfItem(item)) {
    const HashedInput& input =
        key.inputs.emplace_back(HashedAs(path.string(), known));
    text += "input " + input.sha256 + "\n";
  }
  key.sha256 = Sha256Of(text);
  return key;
}

}  // namespace hindsight
