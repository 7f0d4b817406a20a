#include "io/write/result_manifest.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "io/read/paths.h"
#include "io/write/atomic_file.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr char kProgramName[] = "hindsight";

bool IsRegular(const fs::path& path) {
  std::error_code refused;
  return fs::is_regular_file(fs::symlink_status(path, refused));
}

/// A name in the folder itself: what is listed may be removed.
bool IsEntryName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find('/') == name.npos;
}

/// The names that the manifest lists and its own; the latter also where there
/// is none yet, but not where somebody else's lies.
std::vector<std::string> Listed(const fs::path& folder) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  std::vector<std::string> names;
  if (manifest) names = manifest->files;
  if (manifest || !PathExists(folder / kManifestName)) {
    names.emplace_back(kManifestName);
  }
  return names;
}

bool IsOf(const std::vector<std::string>& listed, const std::string& name,
          Finished finished) {
  return std::any_of(listed.begin(), listed.end(), [&](const auto& own) {
    return name == own ||
           (finished == Finished::kNo && IsUnpublishedName(name, own));
  });
}

/// Names of the files that may be removed, the manifest's own left out.
std::vector<std::string> Removable(const fs::path& folder, Finished finished) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  if (finished == Finished::kYes) {
    return manifest ? manifest->files : std::vector<std::string>();
  }
  const std::vector<std::string> listed = Listed(folder);
  std::vector<std::string> names;
  for (const fs::path& entry : FolderEntries(folder)) {
    const std::string name = entry.filename().string();
    if (name != kManifestName && IsOf(listed, name, finished)) {
      names.push_back(name);
    }
  }
  return names;
}

bool Remove(const fs::path& folder, Finished finished) {
  std::error_code refused;
  for (const std::string& name : Removable(folder, finished)) {
    if (IsRegular(folder / name)) fs::remove(folder / name, refused);
  }
  // Last, so that a kill leaves a folder whose files are still listed.
  if (ReadManifest(folder)) fs::remove(folder / kManifestName, refused);
  fs::remove(folder, refused);
  return !fs::exists(fs::symlink_status(folder, refused));
}

}  // namespace

void WriteManifest(const ResultManifest& manifest, const fs::path& folder) {
  const nlohmann::ordered_json json = {{"program", kProgramName},
                                       {"complete", manifest.complete},
                                       {"files", manifest.files}};
  WriteFileAtomically((folder / kManifestName).string(), json.dump(1) + "\n");
}

std::optional<ResultManifest> ReadManifest(const fs::path& folder) {
  const fs::path path = folder / kManifestName;
  if (!IsRegular(path)) return std::nullopt;
  try {
    std::ifstream text(path);
    const nlohmann::json json = nlohmann::json::parse(text);
    if (json.at("program") != kProgramName) return std::nullopt;
    ResultManifest manifest = {
        json.at("complete").get<bool>(),
        json.at("files").get<std::vector<std::string>>()};
    if (!std::all_of(manifest.files.begin(), manifest.files.end(),
                     IsEntryName)) {
      return std::nullopt;
    }
    return manifest;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::string FindForeign(const fs::path& folder, Finished finished) {
  const std::vector<std::string> listed = Listed(folder);
  for (const fs::path& entry : FolderEntries(folder)) {
    const std::string name = entry.filename().string();
    if (!IsOf(listed, name, finished)) {
      return name + (name == kManifestName
                         ? ", which this program did not write"
                         : std::string(", which is not listed in its ") +
                               kManifestName);
    }
    if (IsRegular(entry)) continue;
    std::error_code refused;
    return name +
           (fs::is_symlink(fs::symlink_status(entry, refused))
                ? ", which is a symbolic link"
                : ", which is no regular file") +
           " in place of the file that was written";
  }
  return "";
}

bool RemoveListed(const fs::path& folder) {
  return Remove(folder, Finished::kYes);
}

bool RemoveUnfinished(const fs::path& folder) {
  return Remove(folder, Finished::kNo);
}

}  // namespace hindsight
