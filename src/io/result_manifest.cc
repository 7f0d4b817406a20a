#include "io/result_manifest.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "io/atomic_file.h"
#include "io/paths.h"

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

std::string FindUnlisted(const fs::path& folder) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  for (const fs::path& entry : FolderEntries(folder)) {
    const std::string name = entry.filename().string();
    const bool listed =
        manifest && (name == kManifestName ||
                     std::find(manifest->files.begin(), manifest->files.end(),
                               name) != manifest->files.end());
    if (!listed || !IsRegular(entry)) return name;
  }
  return "";
}

bool RemoveListed(const fs::path& folder) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  std::error_code refused;
  if (manifest) {
    for (const std::string& name : manifest->files) {
      if (IsRegular(folder / name)) fs::remove(folder / name, refused);
    }
    // Last, so that a kill leaves a folder whose files are still listed.
    fs::remove(folder / kManifestName, refused);
  }
  fs::remove(folder, refused);
  return !fs::exists(fs::symlink_status(folder, refused));
}

}  // namespace hindsight
