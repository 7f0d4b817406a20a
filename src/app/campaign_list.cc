#include "app/campaign_list.h"

#include <glob.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "app/flags.h"
#include "base/error.h"
#include "io/read/csv_records.h"
#include "io/read/paths.h"
#include "io/write/csv_line.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr char kConfigName[] = "config.yaml";

/// Whether the value of that flag of `run` is a path.
bool IsPath(const std::string& name) {
  const std::vector<FlagUse> flags = PassedFlags();
  return std::any_of(flags.begin(), flags.end(), [&](const FlagUse& flag) {
    const std::string& value = flag.placeholder;
    return Dashed(flag.name) == name &&
           (value == "FILE" || value == "DIR" || value == "RESULT");
  });
}

fs::path Absolute(const fs::path& path, const fs::path& from) {
  const fs::path folder = fs::absolute(from.empty() ? "." : from);
  return (folder / path).lexically_normal();
}

/// The configuration that a path stands for: of a folder the one in it, or the
/// folder itself, which `run` looks at as `init` does.
fs::path ConfigOf(const fs::path& path) {
  return IsFile(path / kConfigName) ? path / kConfigName : path;
}

/// Parts of a path that tell it from others, the last first: the folder's name
/// where the configuration is just config.yaml.
std::vector<std::string> NameParts(const fs::path& config) {
  std::vector<std::string> parts;
  if (config.filename() != kConfigName) {
    parts.push_back(IsFolder(config) ? config.filename() : config.stem());
  }
  for (fs::path folder = config.parent_path(); folder.has_filename();
       folder = folder.parent_path()) {
    parts.push_back(folder.filename());
  }
  if (parts.empty()) parts.emplace_back("item");
  return parts;
}

std::string JoinedName(const std::vector<std::string>& parts,
                       std::size_t count) {
  std::string name;
  for (std::size_t i = 0; i < std::min(count, parts.size()); ++i) {
    name = parts[i] + (name.empty() ? "" : "_" + name);
  }
  return name;
}

/// Gives the items without a name the shortest that tells them from all others.
void NameItems(std::vector<CampaignItem>* items) {
  std::map<CampaignItem*, std::size_t> lengths;
  for (CampaignItem& item : *items) {
    if (item.name.empty()) lengths[&item] = 1;
  }
  for (bool is_settled = false; !is_settled;) {
    std::map<std::string, int> uses;
    for (auto& [item, length] : lengths) {
      item->name = JoinedName(NameParts(item->config), length);
    }
    for (const CampaignItem& item : *items) ++uses[item.name];
    is_settled = true;
    for (auto& [item, length] : lengths) {
      if (uses[item->name] == 1) continue;
      if (length == NameParts(item->config).size()) continue;
      ++length;
      is_settled = false;
    }
  }
}

void CheckNames(const std::vector<CampaignItem>& items) {
  constexpr std::size_t kLongest = 200;
  std::map<std::string, fs::path> names;
  for (const CampaignItem& item : items) {
    const bool is_name = !item.name.starts_with('.') &&
                         item.name.find('/') == item.name.npos &&
                         item.name.size() <= kLongest;
    if (!is_name) {
      throw InputError("item '" + item.name +
                       "': expected a name for a folder, at most 200 letters "
                       "without '/', not beginning with '.'");
    }
    const auto [other, is_new] = names.try_emplace(item.name, item.config);
    if (is_new) continue;
    const std::string advice = "; a CSV with a column 'name' tells them apart";
    if (other->second == item.config) {
      throw InputError(item.config.string() + " is listed twice" + advice);
    }
    throw InputError("two items of the name '" + item.name + "' (" +
                     other->second.string() + " and " + item.config.string() +
                     ")" + advice);
  }
}

std::vector<fs::path> GlobMatches(const std::string& pattern) {
  glob_t found = {};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  globfree(&found);
  return paths;
}

/// A column of the CSV: "name", "config", or a flag.
std::string ColumnOf(const std::string& title, const std::string& path,
                     long line) {
  const std::string name = Dashed(title);
  if (name == "config" || name == "name") return name;
  std::vector<std::string> known = {"config", "name"};
  for (const FlagUse& flag : PassedFlags()) {
    known.push_back(Dashed(flag.name));
    if (known.back() == name) return name;
  }
  if (title.find_first_of(";\t") != title.npos) {
    throw InputError(path, line, "expected commas between the columns");
  }
  throw InputError(path, line,
                   "column '" + title +
                       "' is no flag that a campaign passes "
                       "to 'run'" +
                       Suggestion(name, known));
}

std::vector<CampaignItem> ReadListCsv(const std::string& path) {
  const std::vector<CsvRecord> records = ReadCsvRecords(path);
  if (records.size() < 2) {
    throw InputError(path, 0,
                     "expected a line with the names of its columns, 'config' "
                     "and flags of 'run', and a line an item");
  }
  std::vector<std::string> columns;
  for (const std::string& title : records[0].fields) {
    columns.push_back(ColumnOf(title, path, records[0].line));
    if (std::count(columns.begin(), columns.end(), columns.back()) > 1) {
      throw InputError(path, records[0].line,
                       "column '" + title + "' stands there twice");
    }
  }
  const fs::path folder = fs::path(path).parent_path();
  std::vector<CampaignItem> items;
  for (std::size_t i = 1; i < records.size(); ++i) {
    CampaignItem& item = items.emplace_back();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string& field = records[i].fields[k];
      if (field.empty()) continue;
      if (columns[k] == "config") {
        item.config = ConfigOf(Absolute(field, folder));
      } else if (columns[k] == "name") {
        item.name = field;
      } else {
        item.flags[columns[k]] =
            IsPath(columns[k]) ? Absolute(field, folder).string() : field;
      }
    }
    if (item.config.empty()) {
      throw InputError(path, records[i].line,
                       "expected a configuration in the column 'config'");
    }
  }
  return items;
}

std::vector<CampaignItem> ItemsOfWord(const std::string& word) {
  if (fs::path(word).extension() == ".csv" && IsFile(word)) {
    return ReadListCsv(word);
  }
  const std::vector<fs::path> paths =
      PathExists(word) ? std::vector<fs::path>{word} : GlobMatches(word);
  if (paths.empty()) {
    throw UsageError("'campaign' finds nothing that is or fits '" + word +
                     "': expected a configuration, the folder of a "
                     "recording, a pattern of these, or a CSV");
  }
  std::vector<CampaignItem> items;
  for (const fs::path& path : paths) {
    items.push_back({"", Absolute(ConfigOf(path), "."), {}});
  }
  return items;
}

}  // namespace

std::string CampaignItem::Flag(const std::string& name) const {
  const auto found = flags.find(name);
  return found == flags.end() ? "" : found->second;
}

std::vector<FlagUse> PassedFlags() {
  std::vector<FlagUse> flags = RunCommand().flags;
  std::erase_if(flags, [](const FlagUse& flag) {
    return flag.name == "out" || flag.name == "force" || flag.name == "clean" ||
           flag.name == "progress";
  });
  return flags;
}

std::vector<CampaignItem> ReadCampaignList(
    const std::vector<std::string>& words,
    const std::map<std::string, std::string>& common) {
  std::vector<CampaignItem> items;
  for (const std::string& word : words) {
    std::ranges::move(ItemsOfWord(word), std::back_inserter(items));
  }
  for (CampaignItem& item : items) {
    for (const auto& [name, value] : common) {
      item.flags.emplace(name,
                         IsPath(name) ? Absolute(value, ".").string() : value);
    }
  }
  NameItems(&items);
  CheckNames(items);
  return items;
}

std::string CampaignListText(const std::vector<CampaignItem>& items) {
  std::vector<std::string> header = {"name", "config"};
  std::set<std::string> flags;
  for (const CampaignItem& item : items) {
    for (const auto& [name, value] : item.flags) flags.insert(name);
  }
  header.insert(header.end(), flags.begin(), flags.end());
  std::string text = CsvLine(header);
  for (const CampaignItem& item : items) {
    std::vector<std::string> fields = {item.name, item.config.string()};
    for (const std::string& flag : flags) fields.push_back(item.Flag(flag));
    text += CsvLine(fields);
  }
  return text;
}

}  // namespace hindsight
